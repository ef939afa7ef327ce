"""How the site is made of the pages: `python -m sphinx -W docs site`."""

import gc
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
os.environ["NUMBA_DISABLE_JIT"] = "1"  # a docstring needs no compiler

import numba  # noqa: E402, F401

import atmosbox  # noqa: E402

del os.environ["NUMBA_DISABLE_JIT"]  # but notebooks do, which run in a process of their own
os.environ["PYTHONPATH"] = os.pathsep.join([str(HERE.parent), os.environ.get("PYTHONPATH", "")])

gc.set_threshold(200_000)  # pages are trees that stay: to look through them again and again finds nothing

project = "atmosbox"
author = "The atmosbox developers"
copyright = author
release = version = atmosbox.__version__
language = "en"
smartquotes = False  # the pages have the signs that they mean, and `--set` is no dash

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.linkcode",
    "numpydoc",
    "extension.contents",
    "extension.docstring",
    "extension.source",
    "extension.mathml",
    "extension.picture",
    "extension.gallery",
]
exclude_patterns = ["figures", "examples", "extension", "jobs"]
nitpicky = True

# A notebook is kept without its output: the site runs it, and a cell that fails is a failure of the site.
nb_execution_mode = "force"
nb_execution_timeout = 300
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_merge_streams = True
nb_number_source_lines = False

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
myst_dmath_double_inline = True

autodoc_default_options = {"members": True}
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
autodoc_inherit_docstrings = False
python_maximum_signature_line_length = 88
python_use_unqualified_type_names = True
add_module_names = False
default_role = "literal"
numpydoc_show_class_members = False
numpydoc_xref_param_type = False

# Their pages are on the network, and the site has to be built, and read, without one.
nitpick_ignore_regex = [
    (r"py:.*", r"(numpy|np|npt|xarray|xr|netCDF4|matplotlib|pathlib|types|typing|collections|os)(\..*)?"),
    (r"py:class", r"ArrayLike|NDArray|Figure|ModuleType|Path|Progress|RunDataset|Show"),
    (r"py:class", r"(tuple|Mapping)\[(str|Parameter)"),  # of an annotation that Sphinx splits
]

html_theme = "furo"
html_title = f"atmosbox {release}"
html_static_path = ["look"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_copy_source = False
html_show_sourcelink = False
html_show_copyright = False
html_use_index = True
html_domain_indices = False
html_theme_options = {
    "navigation_with_keys": True,
    "light_css_variables": {"color-brand-primary": "#0072b2", "color-brand-content": "#005c92"},
    "dark_css_variables": {"color-brand-primary": "#56b4e9", "color-brand-content": "#7cc4ee"},
}
pygments_style = "friendly"
pygments_dark_style = "monokai"
highlight_language = "none"


def linkcode_resolve(domain: str, info: dict[str, str]) -> str | None:
    """Return where the source of an object is shown."""
    from extension.source import link_to_member

    return link_to_member(info["module"], info["fullname"]) if domain == "py" else None
