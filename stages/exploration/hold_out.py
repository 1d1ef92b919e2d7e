"""Which places are known from training, and which the robot touches to find out what it holds."""

import numpy as np

SHARE = 0.25  # of each object's touches held out, as in T4.2.4
SPLITS = ("anywhere", "apart")


def hold_out(truth, places, split, apart, random):
    """(train, test) indices of touches (k,) with objects truth (k,) and places (k, 3), in rising order.

    A quarter of each object's touches is held out: `anywhere`, drawn at random, so that a test array overlaps training
    arrays; or `apart`, one region of each object, where only touches farther than `apart` units from all of the region
    are left for training. random: a numpy generator. Raises ValueError where an object keeps no touch to train on.
    """
    if split not in SPLITS:
        raise ValueError(f"no split is called {split}: there are {', '.join(SPLITS)}")
    train, test = [], []
    for one in np.unique(truth):
        own = np.flatnonzero(truth == one)
        count = round(SHARE * len(own))
        if split == "anywhere":
            out, rest = np.split(random.permutation(own), [count])
        else:
            gaps = np.linalg.norm(places[own][:, None] - places[own][None], axis=2)
            region, others = np.split(np.argsort(gaps[random.integers(len(own))], kind="stable"), [count])
            out, rest = own[region], own[others[(gaps[others][:, region] > apart).all(axis=1)]]
        if len(out) == 0 or len(rest) == 0:
            raise ValueError(f"object {one} has too few touches ({len(own)}) to hold some out {split}")
        test.append(np.sort(out))
        train.append(np.sort(rest))
    return np.concatenate(train), np.concatenate(test)
