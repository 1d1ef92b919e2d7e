"""Claims of T3.1 on simplified meshes: channels, their combinations, and the detectors of the literature.

Each is judged on this run's data set; tables/lod_claims has them on every set.
"""

from stages.report.tables.table_3_1_5_combinations import COMBINATIONS

from ._errors import LOW, falls_with_faces, higher_than_each, ranks_agree, room_within, wider_at_few_faces
from ._meshes import (
    ALL_COUNTS,
    CLASSICAL,
    DIAGONAL,
    ENHANCED,
    HKS,
    MANY_POINTS,
    RANKS,
    REST,
    RIVALS,
    SYMMETRIES,
    claim,
    lod_claim,
)

MARGIN = 0.0002  # T3.1.5: "within a difference of 0.0002"; read as a share of the diagonal
SYMMETRY_MARGIN = 0.1  # T3.1.5: "within a 0.1 difference", of the perceptual errors
OTHERS = [name for name in COMBINATIONS if name not in (CLASSICAL, "VisAttAll", *SYMMETRIES, "Curv")]

CHANNELS = [  # T3.1.5, in its order
    claim(
        "curvature_points", "T3.1.5", "Added curvature points (VisAttCurvP) have the highest error of the variants.",
        "Metro mean error, VisAttCurvP minus the worst of VisAtt, Curv, VisAttCurv, at 1,500 faces",
        higher_than_each("VisAttCurvP", [CLASSICAL, "Curv", "VisAttCurv"], targets=[LOW]),
    ),
    lod_claim(
        "curvature_ssim", "T3.1.5", "Curvature in the map is slightly better as seen (VisAttCurv).",
        CLASSICAL, "VisAttCurv", "ssim_error",
    ),
    claim(
        "more_faces", "T3.1.5", "The error falls with more faces.",
        "Metro mean error at the fewest faces minus at the most, enhanced attention (SSIM)",
        falls_with_faces(ENHANCED), DIAGONAL,
    ),
    claim(
        "wider_apart", "T3.1.5", "Methods differ more at lower resolutions.",
        "standard deviation of the combinations' Metro mean errors, 1,500 minus 3,000 faces",
        wider_at_few_faces(COMBINATIONS), DIAGONAL,
    ),
    lod_claim(
        "symmetry_alone", "T3.1.5", "Symmetry alone (SymLat, SymRad, 2Sym) is slightly better than VisAtt.",
        CLASSICAL, SYMMETRIES, "ssim_error",
    ),
    claim(
        "symmetry_same", "T3.1.5", "The symmetry channels alone lead to roughly the same errors.",
        f"{MARGIN} minus the larger Metro mean difference of SymRad and 2Sym from SymLat, at 1,500 and 3,000 faces",
        room_within(MARGIN, ["SymRad", "2Sym"], "SymLat"), "of the diagonal",
    ),
    lod_claim(
        "symmetry_in", "T3.1.5", "Symmetry in the map (VisAttSym) is slightly worse as seen than the classical model.",
        "VisAttSym", CLASSICAL, "ssim_error",
    ),
    claim(
        "symmetry_within", "T3.1.5", "VisAttSym stays within 0.1 of the classical model's perceptual errors.",
        f"{SYMMETRY_MARGIN} minus the largest difference in SSIM error, DLap and Dnor, at 1,500 and 3,000 faces",
        room_within(SYMMETRY_MARGIN, ["VisAttSym"], CLASSICAL, ("ssim_error", "dlap", "dnor")), "of the error",
    ),
    claim(
        "combinations_same", "T3.1.5", "All combinations but VisAttAll stay within 0.0002 of the classical model.",
        f"{MARGIN} minus the Metro mean difference of the farthest combination, at 1,500 and 3,000 faces",
        room_within(MARGIN, OTHERS, CLASSICAL), "of the diagonal",
    ),
    lod_claim(
        "all_channels", "T3.1.5", "All channels with equal weights are slightly worse (VisAttAll).",
        "VisAttAll", CLASSICAL, "metro_mean",
    ),
    lod_claim(
        "entropy", "T3.1.5", "Entropy makes the error higher on objects without texture (VisAttEnt).",
        "VisAttEnt", CLASSICAL, "metro_mean",
    ),
    lod_claim(
        "contrast", "T3.1.5", "Adding contrast (VisAttCon) gives the best quality of the combinations of channels.",
        REST, "VisAttCon", "metro_mean",
    ),
    lod_claim(
        "contrast_curvature_symmetry", "T3.1.5", "VisAttCurvSymCon gives the best quality, too.",
        REST, "VisAttCurvSymCon", "metro_mean",
    ),
]  # fmt: skip

DETECTORS = [
    lod_claim(
        "attention_rivals", "T3.1.5", "Attention, in all combinations, leads to a lower error than the detectors.",
        RIVALS, COMBINATIONS, "metro_mean",
    ),
    lod_claim(
        "attention_hks", "T3.1.5", "HKS is the exception: its error is lower than that of attention.",
        COMBINATIONS, HKS, "metro_mean",
    ),
    claim(
        "points_errors", "T3.1.5", "More points go with larger errors.",
        f"rank correlation of points and Metro mean error over the methods, {ALL_COUNTS}",
        ranks_agree("points", "metro_mean"), RANKS,
    ),
    lod_claim(
        "curvature_salient_points", "T3.1.5", "VisAttCurvP has smaller errors than SP with about as many points.",
        "salient_points", "VisAttCurvP", "metro_mean",
    ),
    lod_claim(
        "many_points_distort", "T3.1.5", "Methods with many points (SDC, 3DH) distort at low resolution.",
        MANY_POINTS, COMBINATIONS, "metro_max", [LOW],
    ),
]  # fmt: skip

CLAIMS = [*CHANNELS, *DETECTORS]
