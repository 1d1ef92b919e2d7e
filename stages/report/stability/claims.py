"""Claims of T6.3: what a denoising autoencoder is worth to recognition by touch, beside a median filter."""

from stages.kit.split import Split
from stages.report.claims import Claim

from .touch import DENOISED, PLAIN, STAGE

LEARNED, FILTERED = f"{PLAIN}_autoencoder", f"{PLAIN}_median"
PHRASES = {
    ("features", PLAIN): "touches as they are", ("features", LEARNED): "after the autoencoder",
    ("features", FILTERED): "after the median filter", ("perturbation", "noise"): "noise",
    ("perturbation", "dead_cells"): "dead cells", ("perturbation", "blur"): "blur",
    ("perturbation", "none"): "undisturbed touches",
}  # fmt: skip
SENTENCES = {  # (perturbation, first, second): what is claimed
    **{
        (fault, LEARNED, PLAIN): f"A denoising autoencoder makes recognition by touch more accurate under {words}."
        for fault, words in (("noise", "noise"), ("dead_cells", "dead cells"), ("blur", "blur"))
    },
    **{
        (fault, LEARNED, FILTERED): f"Under {words} a denoising autoencoder is better than a median filter."
        for fault, words in (("noise", "noise"), ("dead_cells", "dead cells"), ("blur", "blur"))
    },
    ("none", LEARNED, PLAIN): "On touches without noise a denoising autoencoder does no harm.",
}

CLAIMS = [
    Claim(
        key=f"{first.removeprefix(f'{PLAIN}_')}_over_{'none' if second == PLAIN else 'median'}_{fault}", section="T6.3",
        sentence=sentence, stage=STAGE, dataset=DENOISED, first={"features": first}, second={"features": second},
        where={"perturbation": fault, "split": Split.RANDOM, "classifier": "knn", "metric": "accuracy"},
        within=("severity",), phrases=PHRASES,
    )
    for (fault, first, second), sentence in SENTENCES.items()
]  # fmt: skip
