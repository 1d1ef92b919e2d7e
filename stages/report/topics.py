"""The pages of the site: what each is about, the picture it begins with, and what it shows open."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Topic:
    """A page.

    pictures: the page begins with the first of these that was drawn. shown: the items that stand open, in order, the
    one that the findings rest on first; all others of the page are folded. Items are KIND/NAME.
    """

    title: str
    lead: str
    pictures: tuple[str, ...] = ()
    shown: tuple[str, ...] = ()
    folded: tuple[str, ...] = ()


TOPICS = {
    "look": Topic(
        "Look",
        "Where people look at an object, and which method predicts it.",
        ("figures/figure_3_12", "figures/figure_3_35"),
        ("tables/attention_gaze", "tables/table_3_1", "tables/fixation"),
    ),
    "simplify": Topic(
        "Simplify",
        "Fewer faces, but not where people look: which error that costs, and how many faces a scene needs.",
        ("figures/figure_3_8", "figures/figure_3_5"),
        ("tables/table_3_2", "tables/flip", "tables/scene"),
    ),
    "touch": Topic(
        "Touch",
        "What a pressure array feels, where to press it, and how many cells it needs.",
        ("figures/touch_one_mesh", "tradeoff/sensor_size"),
        ("tables/table_4_1", "tables/figure_4_11", "tables/simulated_to_real", "tables/table_4_4"),
        ("tradeoff/sensor_size",),
    ),
    "know": Topic(
        "Know",
        "What the object is: from a look, from touches, and from both.",
        ("figures/look_and_touch_story", "tradeoff/look_and_touch"),
        ("tables/look_and_touch", "tables/table_4_6", "tables/table_4_9", "tables/table_5_4", "tables/real_networks"),
        ("tables/table_4_5", "tradeoff/look_and_touch", "tables/recognition"),
    ),
    "stability": Topic(
        "Stability",
        "How much noise, damage and error each method bears, and where it breaks.",
        ("figures/stability",),
        ("tables/stability", "tables/touch_stability", "tables/look_and_touch_breaking"),
        ("figures/look_and_touch_stability",),
    ),
    "speed": Topic(
        "Speed",
        "What accuracy costs: each measured row stores its time, and benchmarks time what users run.",
        ("tradeoff/attention",),
        ("tables/backends", "tradeoff/simplification", "tradeoff/saliency", "tradeoff/scene"),
        ("tradeoff/touch", "tradeoff/sequences", "tradeoff/networks", "tradeoff/network_sizes", "tradeoff/fixation"),
    ),
}  # fmt: skip


def page_of(page: str, item: str) -> str:
    """The page of an item, KIND/NAME: the topic that names it, else the page of its part."""
    named = (name for name, topic in TOPICS.items() if item in (*topic.shown, *topic.folded))
    pictured = (name for name, topic in TOPICS.items() if item in topic.pictures[:1])
    return next(named, next(pictured, page))
