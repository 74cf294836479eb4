#!/usr/bin/env python3
"""The commands schema and init, and whether the schema says what the parser does. usage: schema_test.py PROGRAM SWEEP"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema
import yaml

from program import SOURCE


class Loader(yaml.SafeLoader):
    """Numbers, flags and nothing else as YAML 1.2 has them, like the editors' servers and the parser."""


Loader.yaml_implicit_resolvers = {}
NUMBER = re.compile(r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$")
for tag, pattern, first in (("bool", re.compile(r"^(true|false)$"), "tf"),
                            ("int", re.compile(r"^[-+]?[0-9]+$"), "-+0123456789"),
                            ("float", NUMBER, "-+.0123456789"),
                            ("null", re.compile(r"^(~|null|)$"), ["~", "n", ""])):
    Loader.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", pattern, first)


def load(text):
    return yaml.load(text, Loader)


def run(program, *arguments, folder=None, ranks=None):
    """Exit code, output, errors."""
    launch = [SOURCE / "scripts" / "mpirun_local.sh", str(ranks)] if ranks else []
    done = subprocess.run([*launch, program, *map(str, arguments)], capture_output=True, text=True, timeout=60, cwd=folder)
    return done.returncode, done.stdout, done.stderr


def check_schema(program):
    """The schema is one, is the same in a file and on two ranks, and takes all cases that come with the program."""
    code, text, _ = run(program, "schema")
    assert code == 0
    schema = json.loads(text)
    jsonschema.Draft7Validator.check_schema(schema)
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    code, said, _ = run(program, "schema", "--output", folder / "sub" / "s.json", ranks=2)
    assert code == 0 and said.count("wrote") == 1, said
    assert (folder / "sub" / "s.json").read_text() == text
    validator = jsonschema.Draft7Validator(schema)
    cases = [path for path in sorted((SOURCE / "configs").rglob("*.yaml"))]
    assert len(cases) > 30
    for case in cases:
        errors = list(validator.iter_errors(load(case.read_text())))
        assert not errors, (case, errors[0])
    return validator


def check_sweep(validator, sweep):
    """Parser and schema take and refuse the same values of every key."""
    done = subprocess.run([sweep], capture_output=True, text=True, timeout=60, check=True)
    counts = {"yes": 0, "no": 0}
    for line in done.stdout.splitlines():
        verdict, case = line.split(" ", 1)
        valid = validator.is_valid(load(case))
        assert valid == (verdict == "yes"), f"parser: {verdict}, schema: {valid}: {case}"
        counts[verdict] += 1
    assert counts["yes"] > 300 and counts["no"] > 800, counts
    print("parser and schema agree on", counts)


def check_descriptions(validator):
    """An editor shows a text for every key."""
    def visit(path, schema):
        assert schema["description"].endswith(".") and "](" not in schema["description"], path
        for name, below in schema.get("properties", {}).items():
            visit(f"{path}.{name}", below)
    visit("", validator.schema)
    sizing = validator.schema["properties"]["sizing"]["properties"]
    assert sizing["growth"]["minimum"] == 1.01 and sizing["growth"]["default"] == 1.3
    assert "from the model" in sizing["minimum"]["description"]
    assert "interface_angle" not in json.dumps(validator.schema)


def check_init(program, validator):
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    (folder / "wing.step").write_text("")
    code, said, _ = run(program, "init", "--geometry", "wing.step", folder=folder, ranks=2)
    assert code == 0 and "aeroloom check case.yaml" in said and said.count("wrote") == 1, said
    text = (folder / "case.yaml").read_text()
    assert text.splitlines()[0] == "# yaml-language-server: $schema=aeroloom.schema.json"
    assert json.loads((folder / "aeroloom.schema.json").read_text()) == validator.schema
    case = load(text)
    assert case["geometry"] == {"file": "wing.step"} and validator.is_valid(case), case

    code, _, said = run(program, "init", folder=folder)
    assert code == 2 and "--force" in said and (folder / "case.yaml").read_text() == text, said
    code, said, _ = run(program, "init", "--force", "--full", folder=folder)
    full = (folder / "case.yaml").read_text()
    assert code == 0 and "geometry.file" in said and len(full) > 2 * len(text) and validator.is_valid(load(full)), said

    (folder / "aeroloom.schema.json").write_text("{}")
    code, _, said = run(program, "init", "other.yaml", folder=folder)
    assert code == 2 and "no schema of Aeroloom" in said and not (folder / "other.yaml").exists(), said
    code, said, warned = run(program, "init", "sub/other.yaml", "--no-schema", "--geometry", "no.step", folder=folder)
    assert code == 0 and "no.step is not there" in warned and not (folder / "sub" / "aeroloom.schema.json").exists()
    assert "language-server" not in (folder / "sub" / "other.yaml").read_text()
    code, _, said = run(program, "init", "sub", folder=folder)
    assert code == 2 and "is a folder" in said, said
    code, _, said = run(program, "init", "wing.step/case.yaml", folder=folder)
    assert code == 7, said


def check_template_meshes_nothing_new(program):
    """From init to check without touching the file, but for the geometry."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_"))
    assert run(program, "init", folder=folder)[0] == 0
    code, said, errors = run(program, "check", "case.yaml", folder=folder)
    assert code == 2 and "geometry.file" in errors, errors
    code, said, errors = run(program, "check", "case.yaml", "--set", "geometry.builtin=transport", "--set",
                             "sizing.target_tetrahedra=20000", folder=folder)
    assert code == 0 and "a volume can be meshed" in said, said + errors


def check_reference(program):
    """Pages are written into a folder; of those that exist the keys alone are renewed."""
    docs = SOURCE / "docs" / "configuration"
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aeroloom_test_")) / "pages"
    assert run(program, "schema", "--markdown", "--output", folder)[0] == 0
    assert sorted(page.name for page in folder.iterdir()) == sorted(page.name for page in docs.iterdir())
    for page in folder.iterdir():
        text = (docs / page.name).read_text()
        keys = page.read_text().split("\n", 2)[2]
        assert keys in text, page.name
        page.write_text(text.replace(keys, "<!-- keys: old -->\n<!-- end of keys -->\n"))
    assert run(program, "schema", "--markdown", "--output", folder)[0] == 0
    for page in docs.iterdir():
        assert (folder / page.name).read_text() == page.read_text(), page.name
    (folder / "sizing.md").write_text("no marks\n")
    (folder / "volume.md").write_text("<!-- keys: old -->\n<!-- end of keys -->\n")
    code, _, said = run(program, "schema", "--markdown", "--output", folder)
    assert code == 2 and "sizing.md" in said and (folder / "sizing.md").read_text() == "no marks\n", said
    assert "old" in (folder / "volume.md").read_text(), "written before the refusal"
    code, _, said = run(program, "schema", "--markdown", "--output", folder / "sizing.md")
    assert code == 2 and "is a file" in said, said
    code, said, _ = run(program, "schema", "--markdown")
    assert code == 0 and all(f"# {page.stem}\n" in said for page in docs.iterdir() if page.stem != "README"), said[:300]


def main():
    program, sweep = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    validator = check_schema(program)
    check_descriptions(validator)
    check_sweep(validator, sweep)
    check_init(program, validator)
    check_template_meshes_nothing_new(program)
    check_reference(program)
    print("schema: ok")


if __name__ == "__main__":
    main()
