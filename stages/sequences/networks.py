"""The two networks of T tables 4.7 and 4.8: one for the film of imprints, one for the series of normals.

Where the tables are silent or cannot be: the fully connected layers have 64 and 32 units; the softmax layer has weights
of its own, since scores bound by the second layer's tanh would cap a probability of eight classes at 0.51, and the sum
of both networks would follow the weaker one; batch normalisation is a channel's, not a cell's; in table 4.8 kernels of
3 x 3 on one row left are 3 frames wide, and pooling by 0.2 is taken for 2. Dropout is the share kept, as in mdCNN.
"""

import pandas as pd
import torch

KEPT_HIDDEN = 0.8  # tables 4.7 and 4.8, first fully connected layer: mdCNN's dropout is the share that is kept
KEPT_CONVOLVED = 0.5  # table 4.8, second convolution
HIDDEN = (64, 32)  # units of the fully connected layers; the tables give none
SMALLEST = 5  # cells a side that the 3D network needs: its second kernel then still fits
SHORTEST = 8  # frames that the second network needs: five and three for its kernels, two for its pooling


class ImageNet(torch.nn.Module):
    """The 3D network of T table 4.7: films (b, frames, rows, cols) u1 to scores (b, classes) before the softmax.

    Frames are taken in steps of five by the first convolution, whose kernel is five frames deep. Where the film is so
    short that less than three steps are left, the second kernel is as deep as they are. The table gives the first
    convolution no activation.
    """

    def __init__(self, frames, cells, classes):
        super().__init__()
        if min(cells) < SMALLEST:
            raise ValueError(f"the 3D network needs imprints of {SMALLEST} x {SMALLEST} cells or more, got {cells}")
        steps, across = _after(frames, 5, 5, 2), [_after(count, 5, 2, 2) for count in cells]
        depth = min(3, steps)
        self.conv1 = torch.nn.Conv3d(1, 8, 5, stride=(5, 2, 2), padding=2)
        self.norm = torch.nn.BatchNorm3d(8)
        self.conv2 = torch.nn.Conv3d(8, 16, (depth, 5, 5), padding=(0, 1, 1))
        left = (steps - depth + 1) * _after(across[0], 5, 1, 1) * _after(across[1], 5, 1, 1)
        self.fc1 = torch.nn.Linear(16 * left, HIDDEN[0])
        self.drop = torch.nn.Dropout(1 - KEPT_HIDDEN)
        self.fc2 = torch.nn.Linear(*HIDDEN)
        self.scores = torch.nn.Linear(HIDDEN[1], classes)

    def forward(self, films):
        found = self.norm(self.conv1(films[:, None]))
        found = torch.tanh(self.conv2(found)).flatten(1)
        found = self.drop(torch.tanh(self.fc1(found)))
        return self.scores(torch.tanh(self.fc2(found)))


class NormalNet(torch.nn.Module):
    """The 1D network of T table 4.8: normals (b, frames, 3) to scores (b, classes) before the softmax."""

    def __init__(self, frames, classes):
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

    def forward(self, normals):
        found = self.norm(torch.relu(self.conv1(normals.transpose(1, 2))))
        found = torch.max_pool1d(torch.relu(self.conv2(found)), 2)
        found = self.drop_convolved(found).flatten(1)
        found = self.drop(torch.relu(self.fc1(found)))
        return self.scores(torch.relu(self.fc2(found)))


def _after(count, kernel, stride, padding):
    return (count + 2 * padding - kernel) // stride + 1


@torch.no_grad()
def layers(network, *inputs):
    """Tidy frame of a network's layers in the order they run: layer, kind, output (shape of one sample), parameters."""
    rows, hooks = [], []
    for name, layer in network.named_children():

        def note(layer, _, found, name=name):
            shape = "x".join(map(str, found.shape[1:]))
            count = sum(p.numel() for p in layer.parameters())
            rows.append({"layer": name, "kind": type(layer).__name__, "output": shape, "parameters": count})

        hooks.append(layer.register_forward_hook(note))
    network.eval()(*inputs)
    for hook in hooks:
        hook.remove()
    return pd.DataFrame(rows)
