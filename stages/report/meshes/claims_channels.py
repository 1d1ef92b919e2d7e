"""Claims of T3.1 on simplified meshes: channels, their combinations, and the detectors of the literature.

Each is judged on the first data set; tables/lod_claims has them on every set.
"""

from stages.report.claims import highest_of

from .differences import falls_with_faces, ranks_agree, room, spread
from .groups import (
    ALL_COUNTS,
    BOTH,
    CLASSICAL,
    COMBINATIONS,
    DIAGONAL,
    ENHANCED,
    FEW_MINUS_MANY,
    HKS,
    LOW,
    MANY_POINTS,
    RANKS,
    REST,
    RIVALS,
    SYMMETRIES,
    claim,
    lod_claim,
)

MARGIN = 0.0002  # T3.1.5: "within a difference of 0.0002"; read as a share of the diagonal
LARGEST = "the largest difference either way, from the margin"
SYMMETRY_MARGIN = 0.1  # T3.1.5: "within a 0.1 difference", of the perceptual errors
OTHERS = tuple(name for name in COMBINATIONS if name not in (CLASSICAL, "VisAttAll", *SYMMETRIES, "Curv"))
ERROR = {"metric": "metro_mean"}

CHANNELS = [  # T3.1.5, in its order
    lod_claim(
        "curvature_points", "T3.1.5", "Added curvature points (VisAttCurvP) have the highest error of the variants.",
        "VisAttCurvP", highest_of(CLASSICAL, "Curv", "VisAttCurv"), "metro_mean", LOW,
    ),
    lod_claim("curvature_ssim", "T3.1.5", "Curvature in the map is slightly better as seen (VisAttCurv).",
              CLASSICAL, "VisAttCurv", "ssim_error"),
    claim(key="more_faces", section="T3.1.5", sentence="The error falls with more faces.", where=ERROR,
          first={"method": ENHANCED}, statistic=falls_with_faces.__name__, scale=100.0, unit=DIAGONAL,
          note="at the fewest faces minus at the largest number"),
    claim(
        key="wider_apart", section="T3.1.5", sentence="Methods differ more at lower resolutions.", where=ERROR,
        first={"method": COMBINATIONS}, contrast=FEW_MINUS_MANY, statistic=spread.__name__, scale=100.0, unit=DIAGONAL,
        note="their standard deviation",
    ),
    lod_claim("symmetry_alone", "T3.1.5", "Symmetry alone (SymLat, SymRad, 2Sym) is slightly better than VisAtt.",
              CLASSICAL, SYMMETRIES, "ssim_error"),
    claim(key="symmetry_same", section="T3.1.5", where=ERROR | BOTH,
          sentence="The symmetry channels alone lead to roughly the same errors.",
          first={"method": ("SymRad", "2Sym")}, second={"method": "SymLat"},
          margin=MARGIN, unit="of the diagonal", statistic=room.__name__, note=LARGEST),
    lod_claim(
        "symmetry_in", "T3.1.5", "Symmetry in the map (VisAttSym) is slightly worse as seen than the classical model.",
        "VisAttSym", CLASSICAL, "ssim_error",
    ),
    claim(key="symmetry_within", section="T3.1.5", where={"metric": ("ssim_error", "dlap", "dnor")} | BOTH,
          sentence="VisAttSym stays within 0.1 of the classical model's perceptual errors.",
          first={"method": ("VisAttSym",)}, second={"method": CLASSICAL},
          margin=SYMMETRY_MARGIN, unit="of the error", statistic=room.__name__, note=LARGEST),
    claim(key="combinations_same", section="T3.1.5", where=ERROR | BOTH,
          sentence="All combinations but VisAttAll stay within 0.0002 of the classical model.",
          first={"method": OTHERS}, second={"method": CLASSICAL},
          margin=MARGIN, unit="of the diagonal", statistic=room.__name__, note=LARGEST),
    lod_claim("all_channels", "T3.1.5", "All channels with equal weights are slightly worse (VisAttAll).",
              "VisAttAll", CLASSICAL, "metro_mean"),
    lod_claim("entropy", "T3.1.5", "Entropy makes the error higher on objects without texture (VisAttEnt).",
              "VisAttEnt", CLASSICAL, "metro_mean"),
    lod_claim(
        "contrast", "T3.1.5", "Adding contrast (VisAttCon) gives the best quality of the combinations of channels.",
        REST, "VisAttCon", "metro_mean",
    ),
    lod_claim("contrast_curvature_symmetry", "T3.1.5", "VisAttCurvSymCon gives the best quality, too.",
              REST, "VisAttCurvSymCon", "metro_mean"),
]  # fmt: skip

DETECTORS = [
    lod_claim(
        "attention_rivals", "T3.1.5", "Attention, in all combinations, leads to a lower error than the detectors.",
        RIVALS, COMBINATIONS, "metro_mean",
    ),
    lod_claim("attention_hks", "T3.1.5", "HKS is the exception: its error is lower than that of attention.",
              COMBINATIONS, HKS, "metro_mean"),
    claim(
        key="points_errors", section="T3.1.5", sentence="More points go with larger errors.", first=ERROR,
        statistic=ranks_agree.__name__, unit=RANKS, note=f"with the number of points, over the methods, {ALL_COUNTS}",
    ),
    lod_claim("curvature_salient_points", "T3.1.5", "VisAttCurvP has smaller errors than SP with about as many points.",
              "salient_points", "VisAttCurvP", "metro_mean"),
    lod_claim("many_points_distort", "T3.1.5", "Methods with many points (SDC, 3DH) distort at low resolution.",
              MANY_POINTS, COMBINATIONS, "metro_max", LOW),
]  # fmt: skip

CLAIMS = [*CHANNELS, *DETECTORS]
