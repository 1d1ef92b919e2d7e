"""The settings in print, held against those of the data sets that the rows name."""

from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest

from haptic_glance.deep.images import to_images
from haptic_glance.know import network as neural_network
from haptic_glance.know.classifiers import CLASSIFIERS, COMPONENTS
from haptic_glance.know.protocol import FOLDS, HOLDOUT
from haptic_glance.look.points.methods import PLUS, SUMS
from haptic_glance.look.views.viewpoints import PRINCIPAL
from haptic_glance.look.weights.svm import SIDE, pixel_samples
from stages.engine.rows import read_rows
from stages.fixation.tasks import viewpoint_sphere
from stages.sensor_size import protocol as arrays
from stages.sequences.classifiers import MAP_DIMENSIONS, Reduced, knn, svm
from stages.sequences.networks import IMAGE_BATCH, NORMAL_BATCH
from stages.weights.training import AREAS, PIXELS
from stages.weights.training import FOLDS as SVM_FOLDS

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
TWENTY = {
    "harris", "mesh_saliency", "salient_points", "corners", "sift", "VisAttCurvP", "VisAttAll", "VisAttSymP",
    "VisAttEnt", "Curv", "VisAttCurv", "VisAttCurvSym", "VisAttSym", "VisAttCurvSymCon", "itti", "VisAttCon", "2Sym",
    "SymLat", "heat_kernel", "SymRad",
}  # fmt: skip
ON_BLACK = {
    "views.background": "black",
    "conspicuity.background": "kept",
    "conspicuity.formulas": "printed",
    "views.size": [900, 1200],
}
QSLIM = {"lod.rings": 3, "lod.backend": "qslim"}
CONTOURS = {
    "contours.strategies": ["random", "thesis_ssim"],
    "contours.count": 22800 // 48,
    "contours.frames": 25,
    "contours.cells": [32, 32],
}


def holds(*needed):
    return lambda value: set(needed) <= set(value)


def without_sums(methods):
    return {name for name in methods if not name.endswith(PLUS + SUMS)} == TWENTY


def test_section_3_1_5(settings, agreement):
    """T3.1.2 to T3.1.5, figures 3.4 to 3.8: viewpoints, background, points, faces, detectors."""
    printed = ON_BLACK | QSLIM | {
        "views.viewpoints": "twelve",
        "views.material": {"ambient": 0.0, "diffuse": 1.0, "specular": 0.0, "shininess": 20.0},
        "meshes.colours": "vertex",
        "salient_points.selection": "centroid",
        "salient_points.methods": without_sums,
        "lod.methods": holds(*TWENTY),
        "lod.targets": holds("1500", "3000"),
        "lod.shrink": False,  # T3.1.3 keeps three rings in any case
        "lod.size": [900, 1200],
    }  # fmt: skip
    agreement("settings", settings("household_3_1", printed))


def test_figure_3_6(settings, agreement):
    """Figure 3.6: the points of twenty detectors, by centroids on twelve views on black."""
    printed = ON_BLACK | {
        "views.viewpoints": "twelve",
        "salient_points.selection": "centroid",
        "salient_points.methods": lambda methods: (
            {name for name in methods if not name.endswith(PLUS + SUMS)} == TWENTY
        ),
    }
    agreement("settings", settings("household_3_1", printed))


def test_backgrounds(settings, agreement):
    """T3.1.5: 1,500 faces on black, grey and white, by the classical model."""
    black, grey, white = (
        settings(name, {"views.background": colour, "lod.targets": holds("1500"), "lod.methods": holds("itti"),
                        "conspicuity.background": "kept", "conspicuity.formulas": "printed"})
        for name, colour in (("household_3_1", "black"), ("household_on_grey", "grey"), ("household_on_white", "white"))
    )  # fmt: skip
    agreement("settings", tuple(sum(counts) for counts in zip(black, grey, white, strict=True)))


def test_table_3_2(settings, agreement):
    """T3.2.9, table 3.2, figures 3.22 to 3.26: colours, methods, selection, faces; four to eight views."""
    guided = ("guided_ed+seen", "guided_ssim+seen", "svm+object")
    printed = ON_BLACK | QSLIM | {
        "meshes.colours": "palette",
        "views.material": lambda material: min(material.specular if hasattr(material, "specular")
                                               else material["specular"], material["diffuse"]) > 0,
        "views.viewpoints": "best",
        "salient_points.selection": "suppression",
        "salient_points.methods": holds(*guided, "VisAttAll", "mesh_saliency", "heat_kernel"),
        "conspicuity.size": [900, 1200],  # T3.2.3
        "lod.methods": holds(*guided, *(f"{name}-adaptive" for name in guided)),
        "lod.targets": ["3000", "1500"],
        "lod.size": [900, 1200],
        "lod.shrink": False,
    }  # fmt: skip
    agreement("settings", settings("gaze_3_2", printed))


def test_svm(settings, agreement):
    """T3.2.3: all pixels of 200 x 200 pictures, balanced, 30 % of them, ten folds; of the object's own SVM."""
    bright = np.random.default_rng(0).random((225, 300))
    truth = np.where(bright > 0.9, 1.0, 0.0)
    features, labels = pixel_samples({"edge": bright, "color": bright**2}, truth, 0, "any")
    salient = cv2.resize(truth, (200, 200), interpolation=cv2.INTER_AREA) > np.exp(-2)
    held, count = settings("gaze_3_2", {"weights.svm": "picture"})
    more = [
        SIDE == 200,
        len(features) == 2 * np.ceil(0.3 * min(salient.sum(), (~salient).sum())),
        labels.sum() == (~labels).sum(),
        SVM_FOLDS == 10,
        PIXELS["picture"] == AREAS["image"],
    ]
    agreement("settings", (held + int(sum(more)), count + len(more)))


def test_section_4_2(settings, agreement):
    """T4.2.1, T4.2.3.1: four principal views at +-y and +-z, the model of T3.1, suppression, contours, 16 x 16."""
    printed = ON_BLACK | {
        "views.viewpoints": "principal",
        "salient_points.selection": "suppression",
        "salient_points.methods": holds(
            "VisAttAll", "itti", "random", "mesh_saliency", "salient_points", "heat_kernel"
        ),
        "imprints.contact": "contours",
        "imprints.cells": [16, 16],
        "classification.touches": [1, 2, 3, 4, 5],
    }
    held, count = settings("household_4_2", printed)
    axes = {tuple(view.axes[2].round(6).tolist()) for view in PRINCIPAL}
    right = axes == {(0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)}
    agreement("settings", (held + right, count + 1))


def test_classifiers(agreement):
    """T4.2.4: the five classifiers and their protocol."""
    knn, svm_4_2, tree, network = (CLASSIFIERS[name](0) for name in ("knn", "svm", "decision_tree", "deep_learning"))
    kernel = getattr(svm_4_2.kernel, "keywords", {"gamma": svm_4_2.gamma})
    held = [
        knn.n_neighbors == 1 and knn.metric == "minkowski" and knn.p == 2,
        kernel["gamma"] == 1,
        svm_4_2.C == 1.5,
        svm_4_2.tol == 0.001,
        tree.max_depth == 10,
        tree.criterion == "accuracy",
        network.epochs == 10,
        COMPONENTS == 12,
        HOLDOUT == 0.25,
        FOLDS == 5,
    ]
    agreement("settings", (sum(held), len(held)))


def test_array_sizes(settings, agreement):
    """Figures 4.9 to 4.11: arrays of 16 and 32 cells, 0.01 and 0.002 apart, four classes, four classifiers."""
    printed = {
        "sensor_size.cells": holds(16, 32),
        "sensor_size.pitches": holds(0.002, 0.01),
        "sensor_size.classes": ["airplane", "chair", "hand", "vase"],
        "sensor_size.classifiers": holds("knn", "svm", "decision_tree", "deep_learning"),
    }
    agreement("settings", settings("princeton_eight", printed))


def test_classifiers_of_arrays(agreement):
    """T4.3.1: ten components, a quadratic SVM, bagged trees, Euclidean kNN, a network by gradient descent."""
    samples, labels = np.random.default_rng(0).normal(size=(40, 10)), np.arange(40) % 4
    nearest, machine, trees, _ = (arrays.classifier(name).fit(samples, labels) for name in arrays.CLASSIFIERS)
    held = [
        arrays.COMPONENTS == 10,
        (machine.kernel, machine.degree) == ("poly", 2),
        trees.bootstrap and len(trees.estimators_) > 1,
        nearest.effective_metric_ == "euclidean",
        not hasattr(neural_network, "RHO"),  # the decay of Adadelta
    ]
    agreement("settings", (sum(held), len(held)))


def test_section_4_4(settings, agreement):
    """T4.4.5 to T4.4.10: 22,800 sequences of 25 frames of 32 x 32 cells, 80:20, 50 and 10 passes."""
    printed = CONTOURS | {
        "meshes.classes": lambda classes: len(classes) == 8 and all(len(meshes) == 3 for meshes in classes.values()),
        "sequences.image_epochs": 50,
        "sequences.normal_epochs": 10,
    }
    agreement("settings", settings("princeton_eight", printed))


def test_section_4_4_8(settings, agreement):
    """T4.4.8: 50 epochs in batches of 10 for the imprints, 10 epochs in batches of 16 for the normals."""
    held, count = settings("princeton_eight", {"sequences.image_epochs": 50, "sequences.normal_epochs": 10})
    agreement("settings", (held + (IMAGE_BATCH == 10) + (NORMAL_BATCH == 16), count + 2))


def test_series_classifiers(agreement):
    """T4.4.9 and T4.4.10: z-scores, a map of 2 to 6 dimensions, ten neighbours, RBF, gamma 1, epsilon 0.5 and C 1."""
    machine, random, labels = svm(reduced=True), np.random.default_rng(0), np.arange(60) % 2
    samples = random.normal(5, 3, (60, 8)) + labels[:, None]
    nearest = knn(reduced=True).fit(samples, labels).nearest_
    scores = Reduced(samples, labels, np.arange(40), np.arange(40, 60)).mapped(None).train
    held = [
        MAP_DIMENSIONS == (2, 3, 4, 5, 6),
        nearest.n_neighbors == 10,
        nearest.effective_metric_ == "euclidean",
        machine.kernel == "rbf",
        machine.gamma == 1,
        machine.tol == 0.5,
        machine.C == 1,
        np.allclose(scores.mean(axis=0), 0) and np.allclose(scores.std(axis=0), 1),
    ]
    agreement("settings", (sum(held), len(held)))


def test_section_5_3(settings, agreement):
    """T5.3: 75:25, momentum 0.9, ten passes of 16 images."""
    printed = {
        "transfer.train_share": 0.75,
        "transfer.momentum": 0.9,
        "transfer.epochs": 10,
        "transfer.batch": 16,
        "transfer.size": 224,
    }
    agreement("settings", settings("princeton_six", printed))


def test_red_channel(agreement):
    """T5.3: the grey values in the red channel, green and blue padded with zeros."""
    imprints = np.random.default_rng(0).random((3, 16, 16), dtype=np.float32)
    literal = np.zeros((3, 3, 16, 16))
    literal[:, 0] = imprints
    agreement("difference", float(np.abs(to_images(imprints, 16).numpy() - literal).max()))


def test_learning_rates(composed_set, agreement):
    """Tables 5.1 to 5.5: how many of the printed rates are among those tried."""
    transfer = composed_set("princeton_six")["transfer"]
    held, count = 0, 0
    for path in sorted((ROOT / "data/reference/thesis").glob("table_5_[1-5]_*.csv")):
        table = pd.read_csv(path)
        for mode in ("finetuned", "frozen"):
            held += int(table[f"lr_{mode}"].isin(transfer[f"{mode}_rates"]).sum())
            count += len(table)
    agreement("settings", (held, count))


def test_section_3_3_2(settings, agreement):
    """T3.3.2: 218 views on nine parallels, one every 15 degrees, and the poles; 32 images a step."""
    held, count = settings("gaze", {"fixation.parallels": 9, "fixation.azimuths": 24, "fixation.batch": 32})
    views = viewpoint_sphere(9, 24)
    agreement("settings", (held + (len(views) == 218) + (len({view.elevation for view in views}) == 11), count + 2))


def test_accuracy_of_the_tasks(agreement):
    """T3.3.2: 96 to 100 % of the test pictures; of two networks and six tasks how many lie in there."""
    rows = read_rows(ROOT / "reports/measurements/gaze/fixation.csv.gz")
    trained = rows["method"].isin(["vgg16-last_block", "resnet50-last_block"])
    values = rows[trained & (rows["metric"] == "accuracy") & (rows["split"] == "views")]["value"]
    agreement("settings", (int(values.between(0.96, 1).sum()), len(values)))
