"""The axis that points up: learns haptic_glance.mesh.upright.WEIGHTS and tests them: `python -m benchmarks.up_axis`, 4
minutes.

Learns from the catalogue of furniture, the household and the objects of psb that stand upright (inspected one by one),
with equal weight for each set, and within a set the root of its number for each class of objects. Each object is laid
on its two other sides, the front more often than the flank where files tell them apart. Tests leave out a tenth of the
classes at a time; the objects with human gaze are never learned from. Prints the weights and writes
reports/bench/up_axis.csv: set, objects, share of them whose axis is right among y and z, their mean probability, and
rows of `calibration`: of the choices in a range of probabilities the share that is right.
"""

import re
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd

from benchmarks import arguments
from haptic_glance.base.files import write_table
from haptic_glance.mesh import MeshError, rotate_to_z_up
from haptic_glance.mesh.files import parse
from haptic_glance.mesh.upright import features
from stages.meshes.sources import SOURCES

OUT, SHARED = Path("reports/bench/up_axis.csv"), Path("../shared/data")
# set: (source, file, the axis that another convention would take, once the object is turned z up: the front of a y-up
# file; objects of the household face anywhere)
LEARNED = {"catalogue": ("", "x"), "household": ("", "y"), "princeton": ("psb.zip", "x")}
TESTED = {"gaze": ("gaze.zip", "x"), "gaze_clouds": ("gaze_clouds.zip", "x")}
FRONT = 0.75  # weight of the other convention's axis in y-up sets, the rest that of the flank
OBJECTS, RIDGE, FOLDS = 300, 10.0, 10  # the sum of all weights; the penalty; parts of the classes
NO_UP = {"carter", "casting", "prot", "rockerarm", "blade"}  # parts of machines and a protein lie anyhow
LEFT_OUT = re.compile(r"cube\w+|sphere\w+|stanfordbunny")  # all sides alike; stanfordbunny is one of the gaze set
ON_WALLS = re.compile(  # hang or lie flat: no shape says which way
    r".*(window|[dD]oor|screen|[cC]urtain|shutter|blinds|frame|[cC]lock|[bB]oard|tv|puerta|switch|[pP]lug|RJ|dimmer|antenna|"
    r"[sS]ocket|intercom|smoke|bell|wall|hanger|towel|[hH]ood|[fF]aucet|fleche|stationn|passage|rug|carpet|mat|tatami|"
    r"newspaper|billet|Sign|sidewalk).*"
)
CLASSES = {  # of the catalogue and the household; another object is its own class
    "lamp": "lamp|lantern|light|candel|chandelier|farola",
    "chair": "chair|silla|fotel|seat|stool|thonet|toilet|bidet|urinal|puff",
    "sofa": "sofa|couch|futon|bench|bank",
    "table": "table|desk|biurko",
    "bed": "bed|crib|mattress|hammock|lounge|letto",
    "cabinet": (
        "cabinet|bookcase|shel|cupboard|wardrobe|drawer|chest|vanity|locker|fridge|freezer|oven|stove|"
        "cooker|wave|washing|box|crate|trunk|container|speaker|stereo|boiler|heater|furnace|radiator|"
        "aquarium|conditioning|refrigerator|dryer"
    ),
    "person": "male|boy|girl|mannequin|doll|boneco|teddy",
    "animal": "dog|cat$|horse|deer|chicken|rabbit|caballito|duck|elephant|pig",
    "plant": (
        "plant|tree|palm|pine|tulip|lily|cactus|bamboo|bonsai|ficus|orchid|maple|poplar|acacia|cypress|"
        "hedge|spatif|yucca|flower|beech|arbol|blossom"
    ),
    "car": "sedan|beetle|renault|car$|truck|bus$|van$|suv|leon|peugeot|chevrolet|ford|lift|madera|train",
    "bike": "bike|scooter|cycle|r6|skateboard|stroller|wheelbarrow",
    "bottle": "bottle|flacon|tetrapak|extinguisher|spray|paste",
    "vessel": (
        "glass$|cup$|mug|vase|jar$|bowl|pot$|pottery|maceta|pan|kettle|basin|creamer|press|bin|can$|barrel|sink"
    ),
    "column": "column|fence|railing|stair|ladder|chimney|fireplace|rails",
    "clothes": "pantalon|robe|blouson|jupe|chap|casq|gant|chau|mocassin|bootie|slipper|shoes|sneaker|clothes|suit$",
    "tool": (
        "knife|fork$|spoon|spatula|tool|pencil|marteau|scie|pelle|broom|tournevis|perceuse|pince|meuleuse|"
        "shovel|scissors|comb$|racket|ruler|marker|lipstick|hammer|brush|flute"
    ),
    "device": (
        "phone|ipad|tablet|camera|keyboard|laptop|ibook|imac|playstation|joystick|printer|dvd|radio|mobile|"
        "remote|apple_pc|mouse"
    ),
}
UPRIGHT = {  # objects of psb by class
    "airplane": "Airplane_62 Airplane_63",
    "bust": "Bust_301 Bust_302 Bust_303 Bust_305 Bust_306",
    "glasses": "Glasses_43 Glasses_44 Glasses_45",
    "chair": "Chair_101 Chair_102 Chair_103",
    "vessel": "Cup_21 Cup_22 Cup_23 Cup_24 Cup_25 Vase_361 Vase_362 Vase_363 Vase_364 Vase_365 Vase_366",
    "animal": "Bird_241 Bird_244 Fish_221 Fish_222 Fish_226 FourLeg_381 FourLeg_385",
    "table": "Table_142 Table_143 Table_144 Table_145 Table_146",
    "person": (
        "Armadillo_281 Armadillo_282 Armadillo_283 Armadillo_284 Armadillo_285 Armadillo_286 Human_2 "
        "Human_3 Human_4 Human_5 Human_6 Teddy_161 Teddy_162 Teddy_163 Teddy_164 Teddy_165 Teddy_166"
    ),
}


def class_of(name):
    """The class of an object by its name, None where its upright pose is not known."""
    known = {member: group for group, names in UPRIGHT.items() for member in names.split()}
    if name in known or re.fullmatch(r"[A-Z][A-Za-z]+_\d+", name):
        return known.get(name)
    if LEFT_OUT.fullmatch(name) or name in NO_UP or ("__" in name and ON_WALLS.fullmatch(name.partition("__")[2])):
        return None
    stem = re.sub(r"(large|medium|small)$", "", name.rpartition("__")[2])
    return next((group for group, words in CLASSES.items() if re.search(words, stem.lower())), stem)


def measured(source, file, other):
    """(table: set, object, class, other axis, whether another convention takes it; differences of the features)."""
    rows, differences = [], []
    items = SOURCES[source](SimpleNamespace(folder=str(SHARED / file), objects=[], up="y"))
    for item in items:
        group = class_of(item.name)
        if group is None and item.name not in NO_UP:
            continue
        try:
            by_axis = features(rotate_to_z_up(parse(item.content(), item.suffix), item.up), ("z", "x", "y"))
        except MeshError:
            continue
        for axis in "xy":
            rows.append((source, item.name, group, axis, axis == other))
            differences.append({name: by_axis["z"][name] - by_axis[axis][name] for name in by_axis["z"]})
    return pd.DataFrame(rows, columns=["set", "object", "class", "axis", "convention"]), pd.DataFrame(differences)


def weights_of(rows):
    """(r,) weights of the rows, see the top."""
    front = np.where(rows["convention"], FRONT, 1 - FRONT)
    weights = np.where(rows["set"] == "household", 0.5, front)
    sizes = Counter(rows.drop_duplicates(["set", "object"])["class"])
    weights = weights / np.sqrt(rows["class"].map(sizes))
    return (weights / weights.groupby(rows["set"]).transform("sum") * OBJECTS / rows["set"].nunique()).to_numpy()


def fit(differences, weights):
    """(f,) weights of the features: logistic regression without intercept, penalised in units of their spread."""
    spread = np.sqrt((differences**2 * weights[:, None]).sum(axis=0) / weights.sum()) + 1e-9
    x, slopes = differences / spread, np.zeros(differences.shape[1])
    for _ in range(20):  # Newton's method
        p = 1 / (1 + np.exp(-x @ slopes))
        curvature = (x * (weights * p * (1 - p))[:, None]).T @ x + RIDGE * np.eye(len(slopes))
        slopes = slopes + np.linalg.solve(curvature, x.T @ (weights * (1 - p)) - RIDGE * slopes)
    return slopes / spread


def left_out(rows, differences):
    """(r,) log odds of each row by the weights that its class was left out of."""
    sizes = rows["class"].value_counts().sort_index().sort_values(ascending=False, kind="stable")
    fold = rows["class"].map({group: number % FOLDS for number, group in enumerate(sizes.index)}).to_numpy()
    odds, weights = np.zeros(len(rows)), weights_of(rows)
    for number in range(FOLDS):
        inside = fold == number
        odds[inside] = differences[inside] @ fit(differences[~inside], weights[~inside])
    return odds


def summary(name, odds):
    """A row of the table: odds (n,) of the right axis over the other one."""
    chance = 1 / (1 + np.exp(-odds))
    return {"set": name, "objects": len(odds), "right": (odds > 0).mean(), "probability": chance.mean()}


def main():
    """Measures, prints and writes."""
    arguments(__doc__)
    learned = [measured(source, *how) for source, how in LEARNED.items()]
    tested = [measured(source, *how) for source, how in TESTED.items()]
    rows, names = pd.concat([frame for frame, _ in learned], ignore_index=True), list(learned[0][1])
    values = pd.concat([frame for _, frame in learned])[names].to_numpy()
    weights = fit(values, weights_of(rows))
    print("WEIGHTS =", {name: round(float(weight), 2) for name, weight in zip(names, weights, strict=True)})
    odds, summaries = left_out(rows, values), []
    for name in LEARNED:
        summaries.append(summary(name, odds[(rows["set"] == name) & rows["convention"]]))
        summaries.append(summary(f"{name}, both other axes", odds[rows["set"] == name]))
    test = pd.concat([frame for frame, _ in tested], ignore_index=True)
    scores = pd.concat([frame for _, frame in tested])[names].to_numpy() @ weights
    upright = test["convention"] & ~test["object"].isin(NO_UP)
    for name in TESTED:
        summaries.append(summary(name, scores[upright & (test["set"] == name)]))
    summaries.append(summary("gaze, parts that lie anyhow", scores[test["convention"] & test["object"].isin(NO_UP)]))
    sure = 1 / (1 + np.exp(-np.abs(odds)))
    for low, high in ((0.5, 0.6), (0.6, 0.7), (0.7, 0.8), (0.8, 0.9), (0.9, 1.0)):
        summaries.append(summary(f"calibration {low} to {high}", odds[(sure >= low) & (sure < high + (high == 1))]))
    table = pd.DataFrame(summaries).round(3)
    print(table.to_string(index=False))
    print("wrong:", *test["object"][upright & (scores < 0)])
    write_table(OUT, table)


if __name__ == "__main__":
    main()
