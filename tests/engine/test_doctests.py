"""No example in a docstring of the engine is left out, although a kernel is not a plain function."""

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


@pytest.mark.skipif(not COMPILED, reason="without numba kernels are plain functions")
def test_doctest_finds_the_examples_of_every_kernel():
    kernels = {
        f"{module.__name__}.{name}"
        for module in MODULES
        for name, thing in vars(module).items()
        if hasattr(thing, "py_func") and thing.__module__ == module.__name__ and ">>>" in (thing.__doc__ or "")
    }
    assert len(kernels) > 30
    finder = doctest.DocTestFinder(exclude_empty=True)
    assert kernels <= {found.name for module in MODULES for found in finder.find(module) if found.examples}
