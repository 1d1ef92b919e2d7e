"""The two networks of T tables 4.7 and 4.8: one for the sequence of imprints, one for the series of normals.

Where the tables say nothing or cannot be followed, these choices were made. The fully connected layers have 64 and 32
units. The softmax layer has weights of its own: scores bounded by the second layer's tanh would limit a probability
among eight classes to 0.51, and the sum of both networks would follow the weaker one. Batch normalisation works per
channel, not per cell. In table 4.8 kernels of 3 x 3 on one remaining row are 3 frames wide, and pooling by 0.2 is read
as 2. Dropout in the tables is the share that is kept, as in mdCNN.
"""

import torch

KEPT_HIDDEN = 0.8  # tables 4.7 and 4.8, first fully connected layer
KEPT_CONVOLVED = 0.5  # table 4.8, second convolution
HIDDEN = (64, 32)  # units of the fully connected layers; the tables give none
SMALLEST = 5  # cells per side that the 3D network needs, so that its second kernel fits
SHORTEST = 8  # frames that the 1D network needs: five and three for its kernels, two for its pooling


class ImageNet(torch.nn.Module):
    """The 3D network of T table 4.7: imprints (b, frames, rows, cols) u1 to scores (b, classes) before the softmax.

    The first convolution has a kernel of five frames and a stride of five. Where fewer than three steps remain after
    it, the second kernel is as deep as they are. The table gives the first convolution no activation.
    """

    def __init__(self, frames: int, cells: tuple[int, int], classes: int) -> None:
        super().__init__()
        if min(cells) < SMALLEST:
            raise ValueError(f"the 3D network needs imprints of {SMALLEST} x {SMALLEST} cells or more, got {cells}")
        steps, across = _output_length(frames, 5, 5, 2), [_output_length(count, 5, 2, 2) for count in cells]
        depth = min(3, steps)
        self.conv1 = torch.nn.Conv3d(1, 8, 5, stride=(5, 2, 2), padding=2)
        self.norm = torch.nn.BatchNorm3d(8)
        self.conv2 = torch.nn.Conv3d(8, 16, (depth, 5, 5), padding=(0, 1, 1))
        remaining = (steps - depth + 1) * _output_length(across[0], 5, 1, 1) * _output_length(across[1], 5, 1, 1)
        self.fc1 = torch.nn.Linear(16 * remaining, HIDDEN[0])
        self.drop = torch.nn.Dropout(1 - KEPT_HIDDEN)
        self.fc2 = torch.nn.Linear(*HIDDEN)
        self.scores = torch.nn.Linear(HIDDEN[1], classes)

    def forward(self, images: torch.Tensor) -> torch.Tensor:
        values = self.norm(self.conv1(images[:, None]))
        values = torch.tanh(self.conv2(values)).flatten(1)
        values = self.drop(torch.tanh(self.fc1(values)))
        return self.scores(torch.tanh(self.fc2(values)))


class NormalNet(torch.nn.Module):
    """The 1D network of T table 4.8: normals (b, frames, 3) to scores (b, classes) before the softmax."""

    def __init__(self, frames: int, classes: int) -> None:
        super().__init__()
        if frames < SHORTEST:
            raise ValueError(f"the 1D network needs {SHORTEST} frames or more, got {frames}")
        self.conv1 = torch.nn.Conv1d(3, 32, 5)
        self.norm = torch.nn.BatchNorm1d(32)
        self.conv2 = torch.nn.Conv1d(32, 32, 3)
        self.drop_convolved = torch.nn.Dropout(1 - KEPT_CONVOLVED)
        self.fc1 = torch.nn.Linear(32 * ((frames - 6) // 2), HIDDEN[0])
        self.drop = torch.nn.Dropout(1 - KEPT_HIDDEN)
        self.fc2 = torch.nn.Linear(*HIDDEN)
        self.scores = torch.nn.Linear(HIDDEN[1], classes)

    def forward(self, normals: torch.Tensor) -> torch.Tensor:
        values = self.norm(torch.relu(self.conv1(normals.transpose(1, 2))))
        values = torch.max_pool1d(torch.relu(self.conv2(values)), 2)
        values = self.drop_convolved(values).flatten(1)
        values = self.drop(torch.relu(self.fc1(values)))
        return self.scores(torch.relu(self.fc2(values)))


def _output_length(count, kernel, stride, padding):
    return (count + 2 * padding - kernel) // stride + 1


@torch.no_grad()
def layers(network: torch.nn.Module, *inputs: torch.Tensor) -> list[dict]:
    """Rows of a network's layers in order of execution: layer, kind, output (shape per sample), parameters as value."""
    rows, hooks = [], []
    for name, layer in network.named_children():

        def record(layer, _, values, name=name):
            shape = "x".join(map(str, values.shape[1:]))
            count = sum(p.numel() for p in layer.parameters())
            rows.append({"layer": name, "kind": type(layer).__name__, "output": shape, "value": count})

        hooks.append(layer.register_forward_hook(record))
    network.eval()(*inputs)
    for hook in hooks:
        hook.remove()
    return rows
