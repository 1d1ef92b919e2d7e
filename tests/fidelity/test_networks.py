"""T tables 4.7 and 4.8: the two networks, entry by entry."""

import pytest

from stages.sequences.networks import ImageNet, NormalNet

pytestmark = pytest.mark.slow


def test_table_4_7(agreement):
    """The 3D network: kernels, strides and paddings are printed as rows, columns, frames."""
    network = ImageNet(25, (32, 32), 8)
    first, second = network.conv1, network.conv2
    held = [
        first.kernel_size == (5, 5, 5),
        first.padding == (2, 2, 2),
        first.stride == (5, 2, 2),
        first.out_channels == 8,
        type(network.norm).__name__ == "BatchNorm3d",
        second.kernel_size == (3, 5, 5),
        second.padding == (0, 1, 1),
        second.stride == (1, 1, 1),
        second.out_channels == 16,
        round(1 - network.drop.p, 6) == 0.8,
        [name for name, _ in network.named_children()][-1] == "fc2",  # then the softmax: ours has a layer between
    ]
    agreement("settings", (sum(held), len(held)))


def test_table_4_8(agreement):
    """The 1D network: a second kernel of three rows on the one row that the first leaves cannot be made."""
    network = NormalNet(25, 8)
    first, second = network.conv1, network.conv2
    held = [
        (first.in_channels, *first.kernel_size) == (3, 5),
        first.stride == (1,) and first.padding == (0,),
        first.out_channels == 32,
        type(network.norm).__name__ == "BatchNorm1d",
        (1, *second.kernel_size) == (3, 3),
        second.out_channels == 32,
        network.fc1.in_features == 32 * round(0.2 * 19),  # pooling by 0.2; ours is by 2
        round(1 - network.drop_convolved.p, 6) == 0.5,
        round(1 - network.drop.p, 6) == 0.8,
        [name for name, _ in network.named_children()][-1] == "fc2",
    ]
    agreement("settings", (sum(held), len(held)))
