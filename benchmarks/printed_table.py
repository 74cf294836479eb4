"""A Markdown table that a benchmark prints row by row, and writes to its page of figures when it is complete."""
import pathlib

from result_page import write_table

RESULTS = pathlib.Path(__file__).resolve().parent / "results"


def add_page_option(parser):
    """--page FILE: the page of figures that the tables are written to, besides being printed."""
    parser.add_argument("--page", type=pathlib.Path, metavar="FILE",
                        help="write the tables to this page too, for example benchmarks/results/NAME.md")


def take_page_option(arguments):
    """The same for a script without a parser: the arguments without the option, and the page or None."""
    if "--page" not in arguments:
        return arguments, None
    at = arguments.index("--page")
    return arguments[:at] + arguments[at + 2:], pathlib.Path(arguments[at + 1])


class PrintedTable:
    """Prints its columns when it begins and each row when it is added: long benchmarks can be watched."""

    def __init__(self, heading, columns):
        self.heading, self.columns, self.rows = heading, list(columns), []
        print("| " + " | ".join(self.columns) + " |\n" + "|---" * len(self.columns) + "|", flush=True)

    def add(self, *cells):
        """Cells that a failed row lacks stay empty."""
        row = [str(cell) for cell in cells]
        row += [""] * (len(self.columns) - len(row))
        self.rows.append(row)
        print("| " + " | ".join(row) + " |", flush=True)

    def save(self, page, note=""):
        """To the page, if there is one."""
        if page:
            write_table(page, self.heading, self.columns, self.rows, note)
