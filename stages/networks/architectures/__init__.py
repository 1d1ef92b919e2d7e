"""One architecture a file: its convolutions up to the last maps, and what classified them.

Each is a function of ImageNet weights (None: torchvision's own random start) that returns Parts. All convolutions take
images that are normalised as torchvision's weights want them, and end at the last maps, before any pooling.
"""
