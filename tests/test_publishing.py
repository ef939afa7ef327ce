"""Files that publish the project: workflows, forms, the host of the site, the package index, the recipe for conda."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import jinja2
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
FORMS = sorted(path for path in ROOT.glob(".github/ISSUE_TEMPLATE/*.yml") if path.stem != "config")
JUDGED = {
    "github-workflows": sorted(ROOT.glob(".github/workflows/*.yml")),
    "github-issue-forms": FORMS,
    "github-issue-config": [ROOT / ".github/ISSUE_TEMPLATE/config.yml"],
    "readthedocs": [ROOT / ".readthedocs.yaml"],
    "citation-file-format": [ROOT / "CITATION.cff"],
}


def judge(schema, *paths):
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.{schema}", *map(str, paths)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.parametrize("schema", JUDGED)
def test_the_files_of_a_host_are_what_its_schema_allows(schema):
    done = judge(schema, *JUDGED[schema])
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_workflow_that_is_wrong_is_found(tmp_path):
    text = (ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8")
    path = tmp_path / "ci.yml"
    path.write_text(text.replace("runs-on:", "run-on:"), encoding="utf-8")
    assert judge("github-workflows", path).returncode == 1


def test_the_workflows_run_what_a_developer_runs():
    flows = {
        path.stem: yaml.safe_load(path.read_text(encoding="utf-8")) for path in ROOT.glob(".github/workflows/*.yml")
    }
    assert [step["run"] for step in flows["ci"]["jobs"]["test"]["steps"] if "run" in step] == ["bash .ci/run"]
    soaked = {
        part: [step["run"] for step in flows["soak"]["jobs"][part]["steps"] if "run" in step][-1]
        for part in ("soak", "fuzz")
    }
    for part, command in soaked.items():
        for name in flows["soak"]["jobs"][part]["strategy"]["matrix"]["part"]:
            assert (ROOT / "tests" / name).is_file()
        for option in re.findall(r"--[a-z-]+", command):
            assert f'"{option}"' in (ROOT / "tests/conftest.py").read_text(encoding="utf-8")
    built = [step["run"] for step in flows["site"]["jobs"]["build"]["steps"] if "run" in step]
    assert built == ["python -m pip install '.[docs]'", "python -m sphinx -W --keep-going docs site"]


def test_every_link_of_the_package_index_page_leads_into_the_repository():
    command = [sys.executable, "-m", "hatch_fancy_pypi_readme"]
    text = subprocess.run(command, cwd=ROOT, capture_output=True, encoding="utf-8", check=True).stdout
    links = re.findall(r"\]\(([^)]+)\)", text)
    repository = PROJECT["urls"]["Repository"]
    raw = repository.replace("github.com", "raw.githubusercontent.com")
    assert len(links) > 20
    assert [link for link in links if not link.startswith(("https://", "#"))] == []
    inside = [link for link in links if link.startswith((repository, raw))]
    assert len(inside) > 15
    for link in inside:
        place = link.removeprefix(f"{repository}/blob/main/").removeprefix(f"{raw}/main/").partition("#")[0]
        assert (ROOT / place).exists(), link
    assert re.findall(rf"!\[[^\]]*\]\({re.escape(raw)}/main/docs/figures/[\w-]+\.png\)", text)


def test_the_recipe_for_conda_asks_for_what_the_package_asks_for():
    def load_file_data(name, from_recipe_dir):
        return tomllib.loads((ROOT / "conda" / name).read_text(encoding="utf-8"))

    def load_file_regex(name, pattern, from_recipe_dir):
        return re.search(pattern, (ROOT / "conda" / name).read_text(encoding="utf-8"))

    source = (ROOT / "conda/meta.yaml").read_text(encoding="utf-8")
    text = jinja2.Template(source).render(load_file_data=load_file_data, load_file_regex=load_file_regex)
    recipe = yaml.safe_load(text)
    assert recipe["package"]["name"] == "atmosbox"
    assert re.fullmatch(r"\d+\.\d+\.\d+", recipe["package"]["version"])
    assert recipe["requirements"]["run"][1:] == [line.lower() for line in PROJECT["dependencies"]]
    hosts = [line.replace(" ", "") for line in recipe["requirements"]["host"]]
    built = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["build-system"]["requires"]
    assert set(built) <= set(hosts)
