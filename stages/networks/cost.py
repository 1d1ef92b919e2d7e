"""The cost of a network per image: parameters, operations, milliseconds."""

import copy
import statistics
import time

import torch
from torch.utils.flop_counter import FlopCounterMode

from .network import count_parameters

RUNS = 9  # timed runs, of which the median is taken
WARM_UPS = 2  # runs before the timed ones


@torch.no_grad()
def cost(network: torch.nn.Module, size: int) -> dict[str, float]:
    """dict(parameters, operations, milliseconds) of a network for one image (1, 3, size, size).

    operations: multiply-adds of convolutions and matrix products, as papers count them. Torch's counter counts the
    multiplication and the addition separately, so this is half its number. Normalisation, activation and pooling are
    not counted. milliseconds: the median of RUNS passes in evaluation mode on one thread of the CPU, whatever the
    network's device. It is the thread's own time, which excludes waiting for other processes and equals wall time on an
    idle machine. The network is unchanged. Raises ValueError for a size below 1 or one that the network cannot take.
    """
    if size < 1:
        raise ValueError(f"the side of the image must be 1 pixel or more, got {size}")
    own = copy.deepcopy(network).cpu().eval()
    image = torch.zeros(1, 3, size, size).contiguous(memory_format=torch.channels_last)
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with FlopCounterMode(display=False) as counter:
            own(image)
        milliseconds = _milliseconds(lambda: own(image))
    except RuntimeError as error:
        raise ValueError(f"the network cannot take an image of 3 x {size} x {size}: {error}") from None
    finally:
        torch.set_num_threads(threads)
    operations = counter.get_total_flops() // 2
    return {"parameters": count_parameters(network), "operations": operations, "milliseconds": milliseconds}


def _milliseconds(run):
    taken = []
    for _ in range(WARM_UPS + RUNS):
        start = time.thread_time()
        run()
        taken.append(1000 * (time.thread_time() - start))
    return statistics.median(taken[WARM_UPS:])
