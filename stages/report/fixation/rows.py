"""What the pieces on T3.3 read: where networks look, beside people, rival models and controls."""

from stages.fixation import viewpoint_sphere
from stages.kit.files import read_arrays
from stages.report.results import NotRun
from stages.report.style import label

FUSED, NARROWED = "ewigc", "ewigc_l4"  # T eq. 3.24 and 3.25
MODELS = {FUSED: "EWIGC", NARROWED: "EWIGC_L4"}
SHAPE, LEVELS = ("convexity", "curvature", "eccentricity"), ("level_1", "level_2", "level_3")
CHOSEN = ("curvature", "eccentricity", "level_1", "level_2")  # what is fused: stages.fixation.tasks.FUSED
TASKS = (*LEVELS, *SHAPE)  # in the order of T figure 3.30
VIEWPOINTS = viewpoint_sphere(1, 3)[:3]  # the three views whose maps are stored, whatever the settings
LEE, OURS = ("rival", "mesh_saliency"), ("rival", "enhanced")
PRIOR, NOISE = ("control", "centre_prior"), ("control", "random")
UNTRAINED = "-random"  # ends the name of a network that learned nothing but its heads
ALL_VIEWS = "all"
WHOLE = ("nss", "auc")  # of all views together; the other metrics are of each of three views
NAMES = {PRIOR: "centre prior", NOISE: "noise"}
TINTS = {"fused": "#0072B2", "rival": "#767676", "control": "#D55E00"}
KINDS = {"fused": "Grad-CAM of a network", "rival": "other model", "control": "control"}
MARKED = "household"  # the data set whose marks come with the project
NO_PEOPLE = "The truth of the marked objects is no gaze: marks by a vision model, no human subjects took part."
PERCENT = 100  # of the bounding sphere's diameter, which is one unit


def sources(results, metric="pcc"):
    """{whose attention the truth is: rows with a value}: of all sets that have rows of fixation, human gaze first.

    Those that have the metric; NotRun where none has. pcc: agreement with people, which needs people's attention.
    """
    found, missing = {}, []
    known = results.datasets("fixation") or [None]
    for dataset in sorted(known, key=lambda name: name != "gaze"):
        try:
            rows = results.rows("fixation", dataset).dropna(subset=["value"])
        except NotRun as absent:
            missing.append(str(absent))
            continue
        if (rows["metric"] == metric).any():
            found[truth_text(rows, metric)] = rows
        else:
            missing.append("no object of this run has ground truth")
    if not found:
        raise NotRun("; ".join(missing), "fixation", runnable=False)
    return found


def best_source(results, metric="pcc"):
    """(whose attention the truth is, rows): human gaze where it was measured, or this run's."""
    return next(iter(sources(results, metric).items()))


def truth_text(rows, metric):
    """`human gaze, 19 meshes`: what the objects of some rows are. Rows measured once name no data set."""
    dataset, count = rows["dataset"].iloc[0] if "dataset" in rows else "gaze", objects(rows, metric)
    if dataset == "gaze":
        return f"human gaze, {count} meshes"
    return f"marks, {count} objects" if dataset == MARKED and metric != "pcc_tasks" else f"{dataset}, {count} objects"


def objects(rows, metric):
    """How many objects have a metric."""
    return rows.loc[rows["metric"] == metric, "item"].nunique()


def scores(rows, metric):
    """Frame objects x (method, task) of a metric: the mean over the three views, or of all views for WHOLE."""
    whole = rows["view"].astype(str) == ALL_VIEWS
    found = rows[(rows["metric"] == metric) & (whole == (metric in WHOLE))]
    return found.pivot_table(index="item", columns=["method", "task"], values="value", sort=False)


def gap(table, first, second):
    """Series of first minus second an object, both (method, task) of a frame of scores; NotRun where one is absent."""
    missing = [detector_text(name) for name in (first, second) if name not in table]
    found = None if missing else (table[first] - table[second]).dropna()
    if missing or found.empty:
        raise NotRun(f"{' and '.join(missing) or 'a pair'} not judged against people", "fixation", runnable=False)
    return found


def detectors(table):
    """The (method, task) of a frame of scores that answer for a whole object: fused maps, rivals, controls."""
    found = [name for name in table if name[1] in MODELS or name[0] in ("rival", "control")]
    return sorted(found, key=lambda name: list(TINTS).index(kind(name)))  # sorted keeps the order within a kind


def kind(name):
    """What sort of detector a (method, task) is: a key of TINTS."""
    if name[0] in ("rival", "control"):
        return name[0]
    return "control" if untrained(name[0]) else "fused"


def untrained(method):
    """True for a network with random weights."""
    return method.endswith(UNTRAINED)


def with_random_weights(method):
    """The same network with random weights."""
    return method.rpartition("-")[0] + UNTRAINED


def networks(rows):
    """The methods that are networks, those that learned from photographs first, in the order of the rows."""
    found = dict.fromkeys(rows.loc[rows["metric"].isin(["pcc", "pcc_tasks"]), "method"])
    found = [method for method in found if method not in ("rival", "control")]
    return sorted(found, key=untrained)


def network_text(method):
    """`VGG16, frozen`: the network of a method and what of it learned."""
    network, _, mode = method.rpartition("-")
    return f"{label(network)}, {'random weights' if mode == 'random' else label(mode)}"


def detector_text(name):
    """A detector (method, task) as a person says it."""
    method, task = name
    if method in ("rival", "control"):
        return NAMES.get(name, label(task))
    return f"{MODELS.get(task, label(task))}, {network_text(method)}"


def people(found):
    """A sentence on the marks, where they are among the truths."""
    return f" {NO_PEOPLE}" if any(source.startswith("marks") for source in found) else ""


def stored(results, name, dataset=None):
    """Arrays of data/SET/fixation/NAME.npz, as stages.fixation.read_attention describes them."""
    path = results.folder("fixation", dataset) / f"{name}.npz"
    if not path.exists():
        raise NotRun(f"no fixation/{name}.npz", "fixation")
    return read_arrays(path)


def stored_networks(arrays):
    """The networks whose attention a file holds, those that learned from photographs first."""
    found = [key.removesuffix(".maps") for key in arrays if key.endswith(".maps")]
    return sorted(found, key=untrained)


def stored_tasks(results, dataset=None):
    """The tasks of a set in the order of the stored maps."""
    return list(dict.fromkeys(results.rows("fixation", dataset, metric="class")["task"]))
