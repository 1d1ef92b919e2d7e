"""What one image costs a network: parameters, operations, milliseconds."""

import copy
import statistics
import time

import torch
from torch.utils.flop_counter import FlopCounterMode

from .network import parameters

RUNS = 9  # of which the median counts
WARM = 2  # runs before the clock starts


@torch.no_grad()
def cost(network, size):
    """dict(parameters, operations, milliseconds) of a network for one image (1, 3, size, size).

    operations: multiply-adds of convolutions and matrix products, as papers count them: half of what torch's counter
    calls floating-point operations, which takes the multiplication and the addition for two. Normalisation, activation
    and pooling are not counted. milliseconds: the median of RUNS passes in evaluation mode on one thread of the CPU,
    wherever the network lies; the thread's own time, so that waiting for others on the same machine does not count,
    and equal to wall time on an idle one. Leaves the network as it was. Raises ValueError for a size below 1 or one
    that the network cannot take.
    """
    if size < 1:
        raise ValueError(f"the side of the image must be 1 pixel or more, got {size}")
    here = copy.deepcopy(network).cpu().eval()
    image = torch.zeros(1, 3, size, size).contiguous(memory_format=torch.channels_last)
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with FlopCounterMode(display=False) as counter:
            here(image)
        milliseconds = _milliseconds(lambda: here(image))
    except RuntimeError as error:
        raise ValueError(f"the network cannot take an image of 3 x {size} x {size}: {error}") from None
    finally:
        torch.set_num_threads(threads)
    operations = counter.get_total_flops() // 2
    return {"parameters": parameters(network), "operations": operations, "milliseconds": milliseconds}


def _milliseconds(run):
    taken = []
    for _ in range(WARM + RUNS):
        start = time.thread_time()
        run()
        taken.append(1000 * (time.thread_time() - start))
    return statistics.median(taken[WARM:])
