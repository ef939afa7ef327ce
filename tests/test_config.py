"""A settings file is read, or refused with what to write instead."""

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from atmosbox.cli.request import Asked, load_config
from atmosbox.errors import ConfigError, FileError


def written(tmp_path, content):
    path = tmp_path / "lift.toml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def test_a_settings_file_names_a_scene_and_its_settings(tmp_path):
    path = written(
        tmp_path,
        'scene = "lifting-dry"\r\n\r\n[settings]\r\ntemperature = "25degC" # warm\r\nmolecules = 4_000\r\n'
        "pressure-top = 300.0\r\nrotation = false\r\n",
    )
    settings = {"temperature": "25degC", "molecules": 4000, "pressure-top": 300.0, "rotation": False}
    assert load_config(path) == load_config(str(path)) == Asked("lifting-dry", settings)


def test_a_settings_file_may_leave_things_out(tmp_path):
    for content, result in [
        ("", Asked("", {})),
        ('\ufeffscene = " sky "', Asked("sky", {})),
        ("settings.seed = 5", Asked("", {"seed": 5})),
        ('engine = "stepped:delta=0.1"', Asked("", {}, "stepped:delta=0.1")),
        ('accuracy = " 2% "', Asked("", {}, accuracy="2%")),
    ]:
        assert load_config(written(tmp_path, content)) == result


def test_a_settings_file_that_says_something_else_is_refused(tmp_path):
    cases = [
        ("[settings]\nt = 25degC", "(at line 2", 'such as temperature = "25degC"'),
        ("[settings]\nt = 1\nt = 2", "(Cannot overwrite a value", "write one name = value a line"),
        ("a = " + "[" * 5000, " is not TOML (", "write one name = value a line"),
        (b"a = 1\n# caf\xe9", ", line 2 is not UTF-8 text", "save the file as UTF-8"),
        ("scene = 1".encode("utf-16"), " is not a settings file", "saved as UTF-8"),
        (b"#" * 1_000_001, " is not a settings file", "at most 1 MB"),
        (b"\x89HDF\r\n\x1a\n", " is a netCDF file", "give it with --from"),
        ("\ntemperature = 25\n", " has temperature outside the table [settings]", "below a line"),
        ("[setings]\nseed = 1", " has setings outside the table [settings]", "name it settings"),
        ("[plot]\nsize = 1", " has plot outside", "below a line [settings]"),
        ("scene = ''", " has scene without a name", 'such as scene = "lifting-dry"'),
        ("accuracy = 0.5", " has accuracy that is not a text", 'such as accuracy = "0.5K"'),
        ("[[settings]]", " has settings that is not a table", "write a line [settings]"),
        ("[settings]\n\na = [1]", " has a that is not a number", "give one number"),
        ("[settings]\n'a b' = {c = 1}", " has a b that is not a number", "give one number"),
    ]
    for content, problem, fix in cases:
        with pytest.raises(ConfigError) as caught:
            load_config(written(tmp_path, content))
        sentence = str(caught.value)
        assert "lift.toml" in sentence
        assert problem in sentence
        assert fix in sentence
        assert sentence.isprintable()
        assert sentence.endswith(".")


toml = st.lists(
    st.sampled_from(
        ["scene", "settings", "[settings]", "[", "]", "\n", " = ", "=", ".", '"', "'", "'''", "a",
         "temperature", "25", "degC", "{", "}", ",", "nan", "1e5", "2020-01-01", "true", "#", "\\", "\\u",
         "é", "\r", "[[", "]]", "\ufeff"]
    )
).map(lambda parts: "".join(parts).encode())  # fmt: skip


@pytest.fixture(scope="module")
def any_file(tmp_path_factory):
    return tmp_path_factory.mktemp("any") / "any.toml"


@given(
    content=st.binary(max_size=60) | st.text(max_size=60).map(lambda text: text.encode("utf-8", "surrogatepass")) | toml
)
@example(content=b"\xef\xbb\xbf\xef\xbb\xbf")
def test_any_file_is_read_or_refused_in_one_sentence(any_file, content):
    any_file.write_bytes(content)
    try:
        scene, settings, *_ = load_config(any_file)
    except (ConfigError, FileError) as error:
        sentence = str(error)
        assert sentence.isprintable()
        assert sentence.endswith(".")
    else:
        assert scene == scene.strip()
        assert all(isinstance(value, bool | int | float | str) for value in settings.values())
