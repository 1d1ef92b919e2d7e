"""One architecture per file: its convolutions up to the last feature maps, and its ImageNet classifier.

Each is a function of ImageNet weights (None: torchvision's random initialisation) that returns an Architecture. All
convolutions take images normalised as for torchvision's weights, and end at the last feature maps, before any pooling.
"""
