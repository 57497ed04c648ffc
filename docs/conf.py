"""Sphinx's settings of the documentation site: `nox -s docs` builds it into docs/_build/html."""

import sys
from importlib.metadata import version as version_of
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "antnav"
author = "The antnav developers"
copyright = author  # noqa: A001 - Sphinx's word
version = release = version_of("antnav")

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
    "citation",
    "commands",
    "gallery",
    "mathml",
    "names",
    "titles",
]
exclude_patterns = ["_build", "_ext"]
root_doc = "index"
nitpicky = True
smartquotes = False  # two hyphens are an option's
highlight_language = "default"

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4

autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "show-inheritance": True}
napoleon_google_docstring = False
napoleon_custom_sections = [("Attributes", "params_style")]
# Types in docstrings are words, as "ndarray of float64 (n, 8)"; those of signatures are links.
napoleon_use_param = False
napoleon_use_rtype = False
OTHERS = "abc|anywidget|collections|concurrent|enum|matplotlib|msgspec|np|numpy|os|pathlib|PIL|threading|types|typing"
nitpick_ignore_regex = [
    ("py:obj", r"antnav\..*"),  # words in backticks
    ("py:class", rf"({OTHERS})\..*"),
    ("py:class", "AnyWidget|Axes|Executor|NDArray|Figure"),  # of others, imported for type checkers only
    ("py:class", r"antnav\..*|Asked|Job|Jumps|CellIndex|Noticed|Panels|Warm"),  # of ours, but nothing that users meet
]
nitpick_ignore = [("py:exc", "Halted"), ("py:class", "_pytest.mark.structures.MarkDecorator")]
default_role = "word"
python_maximum_signature_line_length = 88
toc_object_entries_show_parents = "hide"

html_theme = "furo"
html_title = "antnav"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#005a8c", "color-brand-content": "#005a8c"},
    "dark_css_variables": {"color-brand-primary": "#56b4e9", "color-brand-content": "#56b4e9"},
}
