#!/usr/bin/env python3
"""Pages of measured figures: tables are replaced under their heading and nowhere else; the page of a benchmark that
keeps its figures in a file is what the benchmark makes of that file; all tables in benchmarks/results/ are well formed.

usage: result_pages_test.py SOURCE_DIR
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(SOURCE / "benchmarks"))
sys.dont_write_bytecode = True
from result_page import BEGIN, END, write_table  # noqa: E402

PAGE = f"""# Page

Words.

## First

Before.

{BEGIN}
| a |
|---|
| old |
{END}

After.

## Second

Words alone.

## Third

{BEGIN}
| c |
|---|
| kept |
{END}
"""


def table(*lines):
    return "\n".join((BEGIN, *lines, END))


def check_replaced(page):
    page.write_text(PAGE)
    write_table(page, "First", ["x", "y"], [["1", r"\1"], ["3", "4"]], "A note.")
    new = table("A note.", "", "| x | y |", "|---|---|", r"| 1 | \1 |", "| 3 | 4 |")
    assert page.read_text() == PAGE.replace(table("| a |", "|---|", "| old |"), new), page.read_text()
    write_table(page, "First", ["a"], [["old"]])
    assert page.read_text() == PAGE


def check_added(page):
    page.write_text(PAGE)
    write_table(page, "Second", ["x"], [["1"]])
    added = table("| x |", "|---|", "| 1 |")
    assert page.read_text() == PAGE.replace("Words alone.\n", f"Words alone.\n\n{added}\n"), page.read_text()
    page.write_text(PAGE)
    write_table(page, "Fourth", ["x"], [["1"]])
    assert page.read_text() == f"{PAGE}\n## Fourth\n\n{added}\n", page.read_text()
    page.unlink()
    write_table(page, "Only", ["x"], [])
    assert page.read_text() == f"# {page.stem}\n\n## Only\n\n" + table("| x |", "|---|") + "\n", page.read_text()


def check_refused(page):
    page.write_text(PAGE)
    try:
        write_table(page, "First", ["x", "y"], [["1"]])
    except ValueError:
        assert page.read_text() == PAGE
        return
    raise AssertionError("a row that is too short was written")


def check_stage_times(folder):
    """The page follows from the committed figures."""
    results = SOURCE / "benchmarks" / "results"
    for name in ("stage_times.csv", "stage_times.md"):
        shutil.copy(results / name, folder)
    page = folder / "stage_times.md"
    text = page.read_text()
    page.write_text(text[:text.index(BEGIN)] + table("| gone |", "|---|") + text[text.index(END) + len(END):])
    subprocess.run([sys.executable, "-B", SOURCE / "benchmarks" / "stage_times.py", "--table", folder / "stage_times.csv",
                    "--plot", folder / "plot.svg", "--page", page], check=True, capture_output=True)
    assert page.read_text() == text, page.read_text()
    assert (folder / "plot.svg").read_text() == (results / "stage_times.svg").read_text()


def check_pages():
    pages = sorted((SOURCE / "benchmarks" / "results").glob("*.md"))
    assert pages
    for page in pages:
        text = page.read_text()
        assert text.count(BEGIN) == text.count(END), page
        block = []
        for line in [*text.split("\n"), ""]:
            if line.startswith("|"):
                block.append(line.replace(r"\|", "").count("|"))
            elif block:
                assert len(block) > 1 and len(set(block)) == 1, f"{page}: a table with rows of different lengths: {block}"
                block = []


def main():
    with tempfile.TemporaryDirectory() as name:
        page = pathlib.Path(name) / "page.md"
        check_replaced(page)
        check_added(page)
        check_refused(page)
        check_stage_times(pathlib.Path(name))
    check_pages()


if __name__ == "__main__":
    main()
