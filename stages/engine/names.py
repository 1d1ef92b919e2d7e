"""Names that settings of several stages may have; each function imports them late, since few runs need all."""

from collections.abc import Callable, Container


def method_name() -> Callable[[str], object]:
    """The function that refuses a name that no method of salient points has."""
    from haptic_glance.look.points.methods import method_named

    return method_named


def viewpoints() -> Container[str]:
    """Named sets of viewpoints."""
    from haptic_glance.look.views.viewpoints import VIEWPOINTS

    return VIEWPOINTS


def classifiers() -> Container[str]:
    """Classifiers of touches."""
    from haptic_glance.know.classifiers import CLASSIFIERS

    return CLASSIFIERS


def networks() -> Container[str]:
    """Networks for photographs."""
    from haptic_glance.deep.network import NETWORKS

    return NETWORKS


def perturbations() -> Container[str]:
    """Disturbances of objects, light and pictures."""
    from haptic_glance.disturb.objects import PERTURBATIONS

    return PERTURBATIONS
