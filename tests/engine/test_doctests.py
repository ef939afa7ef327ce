"""The examples in the docstrings of kernels are run, although a kernel is not a plain function.

Doctest looks for functions and may not find those that numba has compiled; here the examples of each kernel are
looked up explicitly, so that none is left out.
"""

import doctest
import importlib
import pkgutil

import pytest

import atmosbox.engine
from atmosbox.engine.core.jit import COMPILED

FOLDERS = [
    importlib.import_module(f"atmosbox.engine.{found.name}") for found in pkgutil.iter_modules(atmosbox.engine.__path__)
]
MODULES = [
    importlib.import_module(f"{folder.__name__}.{found.name}")
    for folder in FOLDERS
    for found in pkgutil.iter_modules(folder.__path__)
]
KERNELS = [
    (module, name)
    for module in MODULES
    for name, thing in vars(module).items()
    if hasattr(thing, "py_func") and thing.__module__ == module.__name__ and ">>>" in (thing.__doc__ or "")
]


@pytest.mark.skipif(not COMPILED, reason="without numba kernels are plain functions")
def test_kernels_with_examples_are_found():
    assert {"earlier_root", "time_to_leave", "uniform", "resolve_wall_hit"} <= {name for _, name in KERNELS}


@pytest.mark.parametrize(("module", "name"), KERNELS, ids=[name for _, name in KERNELS])
def test_the_examples_of_a_kernel_hold(module, name):
    examples = doctest.DocTestParser().get_doctest(
        getattr(module, name).__doc__, dict(vars(module)), name, module.__file__, 0
    )
    report = []
    result = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(examples, out=report.append)
    assert result.attempted > 0
    assert result.failed == 0, "".join(report)


def listed(module):
    """Return the names that a docstring lists, one in each line."""
    return {line.split("`")[1] for line in module.__doc__.splitlines() if line.startswith("`")}


def test_the_engine_says_where_to_find_each_of_its_folders_and_files():
    assert listed(atmosbox.engine) == {folder.__name__.rpartition(".")[2] for folder in FOLDERS}
    for folder in FOLDERS:
        names = [module.__name__.rpartition(".") for module in MODULES]
        assert listed(folder) == {name for package, _, name in names if package == folder.__name__}
