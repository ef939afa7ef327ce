"""The page on other programs: its examples in R and in MATLAB's language run, if R and Octave are installed."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

import atmosbox as ab

PAGE = Path(__file__).resolve().parents[1] / "docs" / "readers.md"


def block(language):
    (found,) = re.findall(rf"```{language}\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert len(found.splitlines()) <= 10
    return found


@pytest.mark.parametrize(("language", "program", "suffix"), [("r", "Rscript", ".R"), ("matlab", "octave-cli", ".m")])
def test_the_ten_lines_of_a_language_read_the_number_of_the_run(tmp_path, language, program, suffix):
    text = block(language)
    if language == "matlab":  # Octave reads netCDF by a package, and may have nothing to draw with
        text = "pkg load netcdf\n" + re.sub(r"^(semilogy|set|xlabel).*\n", "", text, flags=re.MULTILINE)
    if shutil.which(program) is None:
        pytest.skip(f"no {program}")
    run = ab.run("lifting-dry", molecules=60, out=tmp_path / "lifting-dry.nc")
    script = tmp_path / f"script{suffix}"
    script.write_text(text, encoding="utf-8")
    done = subprocess.run([program, str(script)], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert f"{1000 * float(run.lapse_rate_of_the_first_kilometre):.2f} K/km" in done.stdout
