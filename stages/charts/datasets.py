"""Names of data sets that tables and claims ask for, and what each set is in words."""

# Sets with the settings of a section of the thesis.
SECTION_3_1, SECTION_3_2, SECTION_4_2 = "household_3_1", "gaze_3_2", "household_4_2"
SETS_3_1 = SECTION_3_1, "princeton_3_1"  # the protocol of T3.1 on objects of our own and on published ones
FOUR_3_1 = "household_3_1_four"  # from the four principal viewpoints of T3.1.2
MENDED_3_2 = "gaze_3_2_mended"  # T3.2 with mended formulas
GABOR_3_2 = "gaze_3_2_gabor"  # T3.2 with Gabor kernels of sum zero
GREY_3_1 = "gaze_3_1"  # T3.1 on grey meshes with human gaze
SETS_4_2 = "household_4_2_sets", "princeton_4_2_sets", "catalogue_4_2_sets"  # random sets of six objects
SUMS_4_2 = "household_4_2_sums", "princeton_4_2_sums"
GAZED = "gaze", "gaze_clouds"  # sets with recorded human gaze; no object is in both
COLOURED = "furniture_coloured"  # the set whose objects have several hues
ON_GREY, ON_WHITE = "household_on_grey", "household_on_white"  # other backgrounds

DATASETS = {
    SECTION_3_1: "household as in T3.1", SETS_3_1[1]: "psb as in T3.1",
    FOUR_3_1: "household as in T3.1, four viewpoints",
    GREY_3_1: "meshes with human gaze as in T3.1",
    SECTION_3_2: "meshes with human gaze as in T3.2", MENDED_3_2: "meshes with human gaze as in T3.2, formulas mended",
    GABOR_3_2: "meshes with human gaze as in T3.2, Gabor without its mean",
    SECTION_4_2: "household as in T4.2", SETS_4_2[0]: "random sets of household shapes as in T4.2",
    SETS_4_2[1]: "random sets of psb as in T4.2", SETS_4_2[2]: "random sets of furniture as in T4.2",
    SUMS_4_2[0]: "random sets of household shapes as in T4.2, sums of maps",
    SUMS_4_2[1]: "random sets of psb as in T4.2, sums of maps", COLOURED: "furniture in colour",
    ON_GREY: "on grey", ON_WHITE: "on white",
    "gaze": "meshes with human gaze", "gaze_clouds": "point clouds with human gaze", "princeton": "psb",
    "princeton_touched": "psb, 8 classes of 6 objects", "princeton_hands": "psb, several arrays or touches",
    "princeton_4_3_sets": "random sets of psb as in T4.3",
    "princeton_eight": "psb, the thesis's 8 classes", "princeton_six": "psb, the thesis's 6 classes",
    "pressure_images": "recorded pressure array", "biotac_grasps": "recorded fingertips",
    "household_denoised": "household, denoised",
}  # fmt: skip


def dataset_text(name: str) -> str:
    """A data set in words."""
    return DATASETS.get(name, name)
