"""Methods as people write them on a command line."""

import pytest

from haptic_glance.look.points import METHODS
from haptic_glance.look.points.find import check_name
from haptic_glance.look.points.methods import MEANT


@pytest.mark.parametrize(
    ("said", "name"),
    [
        ("thesis", "thesis_ssim"), ("enhanced attention", "thesis_ssim"), ("enhanced", "thesis_ssim"),
        ("visual-attention", "itti"),
        ("ours", "glance"), ("Glance", "glance"), ("glanse", "glance"), ("Lee", "mesh_saliency"), ("visatt", "VisAtt"),
    ],
)  # fmt: skip
def test_another_name_is_answered_with_ours(said, name):
    with pytest.raises(ValueError, match=f"--method {said}: there is no such method .did you mean {name}\\?.$"):
        check_name(said)


def test_what_resembles_nothing_is_answered_with_the_list():
    with pytest.raises(ValueError, match="no such method; choose one of qem, glance, "):
        check_name("xyzzy", ["qem"])


def test_names_that_run_pass_and_others_say_why():
    for name in ("glance", "glance_any_pose", "itti", "thesis_ssim"):
        check_name(name)
    check_name("qem", ["qem"])
    check_name("farthest", points_alone=True)
    for name, why in (
        ("qem", "no such method"),
        ("farthest", "it has no saliency"),
        ("svm", "learned in the pipeline"),
    ):
        with pytest.raises(ValueError, match=f"--method {name}: .*{why}"):
            check_name(name)


def test_every_name_that_is_offered_exists():
    assert set(MEANT.values()) <= set(METHODS) and not set(MEANT) & set(METHODS)
