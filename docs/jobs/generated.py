"""Tables that are read off the code: settings, facts, variables, attributes, layers, and what is printed."""

import ast
import importlib.util
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from jobs.registry import DOCS, ROOT, SCENES, Findings, job

from atmosbox import scenarios
from atmosbox.file import dataset as diagnostics
from atmosbox.file.provenance import global_attributes
from atmosbox.simulation import runner


@job("scenes", quick=True)
def scenes(found: Findings) -> None:
    """Make the table of the scenes, each with its first line, and tell each page its level and minutes."""
    rows = []
    for name in SCENES:
        sentence, level, minutes = scenarios.summaries()[name]
        rows.append([f"[{name}](scenes/{name}.md)", level, str(minutes), sentence])
        found.number(name, f"{level}, {minutes} minutes")
    found.table(["scene", "level", "minutes", "what it shows"], rows)


@job("parameters", quick=True)
def parameters(found: Findings) -> None:
    """Make a table of the settings of each scene but the seed, which all have; `atmosbox info` knows their limits."""
    for name in SCENES:
        rows = [
            [f"`{p.name}`", f"`{p.typed()}`", f"{p.help} ({p.allowed})" if p.choices else p.help]
            for p in scenarios.load(name).Settings.describe()
            if p.name != "seed"
        ]
        found.table(["setting", "default", "what it is"], rows, key=name)


@job("facts", quick=True)
def facts(found: Findings) -> None:
    """Make a table of what is exaggerated in each scene, and by how much."""
    for name in SCENES:
        found.table(["", ""], [[what, text] for what, text in runner.card(runner.prepare(name, {})).facts], key=name)


@job("variables", quick=True)
def variables(found: Findings) -> None:
    """Make the table of everything that a file may hold."""
    series, others = [], []
    for name, each in diagnostics.VARIABLES.items():
        standard = f"; CF: `{each.standard_name}`" if each.standard_name else ""
        told = [f"`{each.units}`" if each.units else "–", each.long_name + standard]
        if each.dims == ("elapsed_time",):
            series.append([f"`{name}`", *told])
        else:
            others.append([f"`{name}`", ", ".join(each.dims), *told])
    what = "what it is; CF standard name, if there is one"
    found.table(["variable", "unit", what], series, "series")
    found.table(["variable", "dimensions", "unit", what], others, "others")


ATTRIBUTES = {
    "Conventions": "`CF-1.11`",
    "title": "title of the scene",
    "institution": "not stated: write yours",
    "source": "atmosbox, its version and its engine",
    "history": "when, and the command as it was typed",
    "references": "source of the method of the engine",
    "comment": "the description of the scene: what is modelled and what is left out; doubts about a sounding",
    "license": "`CC0-1.0`: the numbers are free for any use",
    "date_created": "when, in UTC; `SOURCE_DATE_EPOCH`, if set, is taken instead",
    "product_version": "version of atmosbox",
    "atmosbox_format": "version of this layout",
    "atmosbox_status": "`complete`, `partial` (the run is under way or was killed) or `interrupted` (by Ctrl-C)",
    "atmosbox_parameters": "JSON: scene, settings, engine, version, known errors; `--from FILE` repeats the run",
    "atmosbox_turns": "JSON: each turn of a knob in a [replayed run](lab.md#a-link-is-the-run), with its frame",
    "atmosbox_panels": "JSON: the graphs of the figure, which `atmosbox plot` draws",
    "atmosbox_headlines": "JSON: the names of the main results, in order",
}


@job("attributes", quick=True)
def attributes(found: Findings) -> None:
    """Make the table of the global attributes, and fail if a file has others."""
    made = set(global_attributes({"engine": "exact"}, title="a", command="b", comment="c", references="d"))
    made |= {"atmosbox_headlines", "atmosbox_turns"}
    if made != set(ATTRIBUTES):
        found.failures.append(f"the attributes are not those of the page: {sorted(made ^ set(ATTRIBUTES))}")
    found.table(["attribute", "what it says"], [[f"`{name}`", text] for name, text in ATTRIBUTES.items()])


@job("layers", quick=True)
def layers(found: Findings) -> None:
    """Make the table of who may import whom, as the test has it."""
    path = ROOT / "tests" / "test_layers.py"
    spec = importlib.util.spec_from_file_location("layers_of_atmosbox", path)
    if spec is None or spec.loader is None:
        raise FileNotFoundError(path)
    sys.modules[spec.name] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    rows = []
    for layer, rule in module.LAYERS.items():
        words = [each.replace("*", "everything") or "–" for each in (rule.parts, rule.libraries, rule.lazily)]
        rows.append([f"`{layer}`" if " " not in layer else layer, *(", ".join(text.split()) for text in words)])
    found.table(["layer", "may import of atmosbox", "libraries", "only inside a function"], rows)


def typed(*words: str, folder: Path | None = None, status: int = 0) -> str:
    """Return what atmosbox prints to stdout, or to stderr where a status other than 0 is expected."""
    environment = {**os.environ, "COLUMNS": "100", "NO_COLOR": "1", "PYTHONPATH": str(ROOT), "TERM": "dumb"}
    command = [sys.executable, "-m", "atmosbox", *words]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, encoding="utf-8", check=False)
    if done.returncode != status:
        raise RuntimeError(f"atmosbox {' '.join(words)} ended with {done.returncode}: {done.stderr}")
    return (done.stderr if status else done.stdout).rstrip()


def console(words: str, folder: Path | None = None, status: int = 0) -> str:
    """Return a command and what it prints, as a block of a page."""
    lines = [line.rstrip() for line in typed(*words.split(), folder=folder, status=status).splitlines()]
    return "\n".join(["```console", f"$ atmosbox {words}", *lines, "```"])


@job("refusal")
def refusal(found: Findings) -> None:
    """Type something that cannot be understood."""
    found.text(console("run lifting-dry --set temperature=25m", status=2))


def lines_of_code(source: str) -> int:
    """Return how many lines of a module are neither empty nor part of an import or a docstring."""
    tree = ast.parse(source)
    apart: set[int] = set()
    for node in ast.walk(tree):
        text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        if text or isinstance(node, ast.Import | ast.ImportFrom):
            apart.update(range(node.lineno, (node.end_lineno or node.lineno) + 1))
    return sum(1 for number, line in enumerate(source.splitlines(), 1) if line.strip() and number not in apart)


@job("own-scene")
def own_scene(found: Findings) -> None:
    """Show the example of a scene of one's own, and run it."""
    path = DOCS / "examples" / "my_scene.py"
    source = path.read_text(encoding="utf-8").rstrip()
    found.text(f"```python\n{source}\n```", key="source")
    found.number("lines", sum(1 for line in source.splitlines() if line.strip()))
    found.number("statements", lines_of_code(source))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "my_scene.py").write_text(f"{source}\n", encoding="utf-8")
        found.text(console("run ./my_scene.py", folder), key="run")
        from atmosbox.file.netcdf import read
        from atmosbox.plot import figure

        dataset = read(folder / "my_scene.nc")
        for check in runner.verify(dataset):
            if not check.passed:
                found.failures.append(f"my_scene.py: {check.sentence}")
        found.figure(figure(dataset, "slides"), "own-scene", 100)


@job("sheet-words", quick=True)
def sheet_words(found: Findings) -> None:
    """Show the words of the worksheet for the same scene."""
    text = (DOCS / "examples" / "my_scene.sheet.toml").read_text(encoding="utf-8").rstrip()
    found.text(f"```toml\n{text}\n```")
