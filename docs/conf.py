"""The documentation, by Sphinx: `make docs`. It needs no network, neither when it is built nor when it is read."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "docs")]

project = "Haptic Glance"
author = copyright = "Haptic Glance contributors"
extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx_gallery.gen_gallery",
    "myst_parser",
    "_extensions.docstrings",
    "sphinx.ext.napoleon",  # after our own extension, which links the names in backticks
    "_extensions.mathml",
    "_extensions.measured",
    "_extensions.settings",
    "_extensions.tables",
]
exclude_patterns = ["_extensions", "**/GALLERY_HEADER.rst", "tutorials", "examples"]
suppress_warnings = ["config.cache"]  # a function of the gallery's settings cannot be pickled

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
default_role = "literal"

napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True  # autodoc lists the attributes, too
autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
autosummary_generate_overwrite = True
autosummary_imported_members = True
templates_path = ["_templates"]
python_maximum_signature_line_length = 88
python_use_unqualified_type_names = True
add_module_names = False

html_theme = "pydata_sphinx_theme"
html_math_renderer = "mathml"
html_title = "Haptic Glance"
html_context = {"default_mode": "auto"}  # or each page logs an error
html_static_path = ["_static"]
html_css_files = ["style.css"]
html_js_files = ["names.js"]
html_show_search_summary = False  # it would fetch each page, which a browser refuses to pages of file://
html_show_sourcelink = html_copy_source = False
ALONE = "index first_steps thesis glossary judging design comparison artifact settings"  # no pages beside them
html_sidebars = {name: [] for name in ALONE.split()}
html_theme_options = {
    "header_links_before_dropdown": 5,
    "show_prev_next": False,
    "navigation_with_keys": False,
    "footer_start": ["copyright"],
    "footer_end": [],
}


def smaller_pictures(_settings: dict, _name: str) -> None:
    """Pictures of the gallery at the size at which they are shown."""
    import matplotlib

    matplotlib.rcParams.update({"figure.dpi": 110, "savefig.dpi": 110, "font.size": 10, "image.cmap": "viridis"})


sphinx_gallery_conf = {
    "examples_dirs": ["tutorials", "examples"],
    "gallery_dirs": ["generated/tutorials", "generated/examples"],
    "filename_pattern": r"/\w+\.py$",
    "subsection_order": ["examples/look", "examples/simplify", "examples/touch", "examples/scenes"],
    "within_subsection_order": "_extensions.order.ReadingOrder",
    "abort_on_example_error": True,
    "backreferences_dir": "generated/backreferences",
    "doc_module": ("haptic_glance",),
    "prefer_full_module": {r"haptic_glance.*"},
    "reference_url": {"haptic_glance": None},
    "reset_modules": ("matplotlib", smaller_pictures),
    "thumbnail_size": (400, 280),
    "show_signature": False,
    "show_memory": False,
    "remove_config_comments": True,
    "write_computation_times": False,
    "download_all_examples": False,
}
