"""VGG16's convolutions (Simonyan & Zisserman 2015, T [235])."""

from ..restore import restore
from ..vision import torchvision
from .alexnet import features_of
from .parts import Parts, he_start


def vgg16(state):
    """Parts; state: {`features.N.weight` or `.bias`: tensor}, where `classifier.*` may be too, or None.

    Up to the rectified thirteenth convolution, without the last max pooling: 14 x 14 maps of 512 at 224 pixels, which
    Grad-CAM looks at. The thesis keeps the fully connected layers fc6 and fc7 and replaces fc8; here, since no registry
    has their weights, the maps are pooled by their mean for one new layer. That is 14.7 of 138 million parameters.
    """
    vgg = torchvision.models.vgg
    convolutions = vgg.make_layers(vgg.cfgs["D"])[:-1]  # the whole would first draw its 124 million others
    if state is None:
        he_start(convolutions)
    else:
        restore(convolutions, features_of(state), "vgg16's convolutions")
    return Parts(convolutions, width=512, dropout=0.5, classifier=None)
