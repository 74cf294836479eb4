#!/usr/bin/env python3
"""report.json keeps to its schema, the schema to docs/report.md, and report.html is complete in itself, whatever names the CAD
and the case have. usage: report_test.py PROGRAM"""
import copy
import json
import re
import shutil
import subprocess
import sys

import jsonschema
from page import Page
from program import COARSE_WING, HOSTILE, SHARED_RANKS, SOURCE, Run, shared_run

sys.path.insert(0, str(SOURCE / "scripts"))
from report_pictures import Chromium  # noqa: E402

SCHEMA = json.loads((SOURCE / "docs" / "report.schema.json").read_text())


def faults_of(report):
    return [f"{'/'.join(map(str, e.absolute_path))}: {e.message[:300]}"
            for e in jsonschema.Draft202012Validator(SCHEMA).iter_errors(report)]


def keys_of(schema):
    """All names of properties that a schema declares."""
    if isinstance(schema, list):
        return set().union(*map(keys_of, schema), set())
    if not isinstance(schema, dict):
        return set()
    keys = set(schema["properties"]) if isinstance(schema.get("properties"), dict) else set()
    return keys.union(*map(keys_of, schema.values()), set())


def check_schema(report):
    """The schema is one, is strict, and all that it knows is documented."""
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    for key in ("surprise", "mesh.surprise", "stages.0.surprise", "quality.min_dihedral.surprise"):
        changed = copy.deepcopy(report)
        place = changed
        *path, last = key.split(".")
        for step in path:
            place = place[int(step) if step.isdigit() else step]
        place[last] = 1
        assert faults_of(changed), f"{key} should not be allowed"
    for key in SCHEMA["required"]:
        changed = copy.deepcopy(report)
        del changed[key]
        assert faults_of(changed), f"{key} should be required"
    quoted = set(re.findall(r"[\w.]+", " ".join(re.findall(r"`([^`]*)`", (SOURCE / "docs" / "report.md").read_text()))))
    named = quoted | {word for text in quoted for word in text.split(".")} | {text.lstrip(".") for text in quoted}
    missing = sorted(keys_of(SCHEMA) - named)
    assert not missing, f"docs/report.md does not name {missing}"


def check_page(run_folder, *words):
    page = Page(run_folder / "report.html")
    assert not page.wrong, page.wrong
    missing = [word for word in words if word not in page.text]
    assert not missing, f"{run_folder}/report.html does not say {missing}"
    assert not list(run_folder.glob("*.unfinished"))
    return page


def check_in_browser(folders):
    """No request, nothing on the console, no script has run, nothing wider than a narrow window."""
    if shutil.which("chromium") is None:
        print("skipped: no chromium here")
        return
    browser = Chromium()
    try:
        for folder in folders:
            url = (folder / "report.html").resolve().as_uri()
            browser.load(url)
            for width, paper in ((1200, False), (400, False), (688, True)):
                browser.show(width=width, paper=paper)
                assert browser.evaluate("document.documentElement.scrollWidth <= innerWidth"), f"{url} at {width}"
            assert browser.requests() == [url], browser.requests()
            assert not browser.complaints(), browser.complaints()
            # On paper the folded configuration is there.
            assert browser.evaluate("document.querySelector('details pre').getClientRects().length > 0"), url
    finally:
        browser.close()


def main():
    program = sys.argv[1]
    good = shared_run(program)
    assert not faults_of(good.report), faults_of(good.report)
    check_schema(good.report)
    page = check_page(good.output, HOSTILE, f"{good.report['mesh']['tetrahedra']:,}", good.report["mesh"]["hash"],
                      "Every tetrahedron reaches" if good.report["improve"]["bad_after"] == 0 else "below the target")
    assert "failure" not in page.ids and page.source.count("<tr>") > 20
    assert all(len(stage["cpu_seconds_by_rank"]) == SHARED_RANKS for stage in good.report["stages"])

    sent = [stage["messages"] for stage in good.report["stages"]]
    for kind in ("collective", "neighbour", "rendezvous"):
        assert SHARED_RANKS == 1 or any(stage[kind]["bytes"] > 0 for stage in sent), kind
        for messages in (stage[kind] for stage in sent):
            assert messages["count_max"] <= messages["count"] <= SHARED_RANKS * messages["count_max"], messages
            assert messages["bytes_max"] <= messages["bytes"] <= SHARED_RANKS * messages["bytes_max"], messages

    # A limit that is missed: the mesh is there, and the page says first what it misses.
    missed = Run(program, COARSE_WING, 1, ("improve.gate.min_mean_ratio=0.99", "improve.gate.largest_angle=179",
                                                "improve.gate.largest_edge_ratio=1.5"))
    assert missed.code == 6 and not faults_of(missed.report), faults_of(missed.report)
    assert [row["met"] for row in missed.report["quality"]["gate"]] == [True, False, False]
    page = check_page(missed.output, "improve.gate.min_mean_ratio", "gate failed", "What to do")
    assert page.text.index("What to do") < page.text.index("Is this mesh good?")

    silent = {"count": 0, "count_max": 0, "bytes": 0, "bytes_max": 0}
    assert all(messages == silent for stage in missed.report["stages"] for messages in stage["messages"].values())

    folder = missed.folder

    # CAD that cannot be meshed, in a file whose name is markup.
    shell = folder / "<svg onload=alert(1)>.step"
    shutil.copy(SOURCE / "tests/data/open_shell.step", shell)
    failed = Run(program, f"geometry: {{file: \"{shell}\"}}\nsizing: {{minimum: 1, maximum: 100}}\n", 3)
    assert failed.code == 3 and not faults_of(failed.report), faults_of(failed.report)
    assert failed.report["input"]["bytes"] == shell.stat().st_size
    check_page(failed.output, "Stage geometry failed", shell.name, "aeroloom check", "What to do")

    # A mesh from a file.
    better = folder / "better"
    done = subprocess.run([program, "improve", good.output / "mesh.pvtu", "--set", f"output.directory={better}"],
                          capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, done.stderr
    report = json.loads((better / "report.json").read_text())
    assert not faults_of(report), faults_of(report)
    assert report["input"]["kind"] == "mesh" and report["input"]["file"].endswith("mesh.pvtu")
    check_page(better, "Improved mesh of", HOSTILE)

    check_in_browser([good.output, missed.output, failed.output, better])


if __name__ == "__main__":
    main()
