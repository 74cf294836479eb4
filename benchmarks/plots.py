"""Plots as SVG for the pages in benchmarks/results/, readable in black and white: series differ by dashes, markers and greys.

    panel = Panel("Speed-up", "ranks", "speed-up", x_log=2, y_log=2)
    panel.line("pieces", ranks, speed_up)
    save("plot.svg", [panel])

Nothing but the standard library is needed.
"""
import html
import math
import pathlib

DASHES = ("", "7 4", "2 3", "9 3 2 3", "14 4", "4 2")
GREYS = ("#000", "#000", "#555", "#777", "#333", "#999")
MARKERS = ("disc", "ring", "square", "triangle", "cross", "diamond", "plus")
SIZE = 12  # of text, pixels


def text(x, y, words, anchor="middle", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {more}>{html.escape(words)}</text>'


def line(x1, y1, x2, y2, stroke="#000", dash="", width=1.0):
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" stroke="{stroke}" stroke-width="{width}"{dashes}/>'


def marker(kind, x, y, grey="#000"):
    r = 4
    if kind in ("disc", "ring"):
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r}" stroke="{grey}" fill="{grey if kind == "disc" else "#fff"}"/>'
    if kind == "square":
        return f'<rect x="{x - r:.1f}" y="{y - r:.1f}" width="{2 * r}" height="{2 * r}" stroke="{grey}" fill="#fff"/>'
    points = {"triangle": [(0, -5), (4.5, 4), (-4.5, 4)], "diamond": [(0, -5.5), (5.5, 0), (0, 5.5), (-5.5, 0)]}.get(kind)
    if points:
        at = " ".join(f"{x + dx:.1f},{y + dy:.1f}" for dx, dy in points)
        return f'<polygon points="{at}" stroke="{grey}" fill="{grey if kind == "triangle" else "#fff"}"/>'
    d = 4 if kind == "cross" else 0
    return (line(x - 4, y - d, x + 4, y + d, grey, width=1.5) + line(x - d, y + 4, x + d, y - 4, grey, width=1.5))


def number(value):
    if value != 0 and (abs(value) >= 1e5 or abs(value) < 1e-3):
        power = math.floor(math.log10(abs(value)) + 1e-9)
        digits = str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        lead = value / 10**power
        return f"10{digits}" if abs(lead - 1) < 1e-6 else f"{lead:g}·10{digits}"
    return f"{value:g}".replace("-", "−")


class Axis:
    """From values to 0 .. 1. `log` is its base, 0 for a linear one."""

    def __init__(self, log=0, low=None, high=None):
        self.log, self.low, self.high = log, low, high
        self.fixed = (low is not None, high is not None)

    def fit(self, values):
        values = [v for v in values if not self.log or v > 0]
        if not self.fixed[0]:
            self.low = min(values, default=1)
        if not self.fixed[1]:
            self.high = max(values, default=2)
        if self.log:
            self.low /= 1 if self.fixed[0] else 1.4
            self.high *= 1 if self.fixed[1] else 1.4
        if self.high <= self.low:
            self.high = self.low * self.log if self.log else self.low + 1

    def place(self, value):
        if self.log:
            value = max(value, self.low)
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def ticks(self):
        if self.log:
            first = math.ceil(math.log(self.low, self.log) - 1e-9)
            last = math.floor(math.log(self.high, self.log) + 1e-9)
            return [float(self.log) ** i for i in range(first, last + 1, max(1, math.ceil((last - first) / 10)))]
        step = 10 ** math.floor(math.log10((self.high - self.low) / 4))
        step *= next(f for f in (1, 2, 5, 10) if (self.high - self.low) / (f * step) <= 7)
        first = math.ceil(self.low / step - 1e-9)
        return [step * i for i in range(first, math.floor(self.high / step + 1e-9) + 1)]


class Panel:
    """One plot. With `rows` the y axis has a name for each row, and points() has a value for each of them."""

    def __init__(self, title, x_label, y_label="", *, x_log=0, y_log=0, x=(None, None), y=(None, None), rows=None, width=430,
                 height=300):
        self.title, self.x_label, self.y_label, self.rows = title, x_label, y_label, rows
        self.x, self.y = Axis(x_log, *x), Axis(y_log, *y)
        self.width = width
        self.height = 76 + 24 * len(rows) if rows else height
        self.left = 16 + 6.6 * max(map(len, rows)) if rows else 62
        self.series, self.guides = [], []

    def line(self, name, xs, ys, kind=None):
        self.series.append(("line", name, list(xs), list(ys), len(self.series) if kind is None else kind))

    def steps(self, name, edges, heights, kind=None):
        """A histogram: one edge more than heights."""
        self.series.append(("steps", name, list(edges), list(heights), len(self.series) if kind is None else kind))

    def points(self, name, values, spans=None, kind=None):
        """In each row a point, or None, and where there are spans, the interval around it."""
        self.series.append(("points", name, list(values), list(spans or [None] * len(values)),
                            len(self.series) if kind is None else kind))

    def guide(self, *, x=None, y=None, name=""):
        """A thin line across at x or y, or with both the line y = x."""
        self.guides.append((x, y, name))

    def _values(self):
        xs, ys = [], []
        for what, _, a, b, _ in self.series:
            if what == "points":
                xs += [v for v in a if v is not None] + [v for span in b if span for v in span]
            else:
                xs += a
                ys += [v for v in b if v is not None]
        return xs, ys

    def draw(self, left, top):
        xs, ys = self._values()
        self.x.fit(xs + [x for x, y, _ in self.guides if x is not None and x is not True])
        self.y.fit(ys + [y for x, y, _ in self.guides if y is not None and y is not True] or [0, 1])
        x0, x1 = left + self.left, left + self.width - 14
        y0, y1 = top + self.height - 44, top + 30
        X = lambda v: x0 + (x1 - x0) * min(max(self.x.place(v), 0), 1)
        Y = lambda v: y0 + (y1 - y0) * min(max(self.y.place(v), 0), 1)
        row = lambda i: y1 + (y0 - y1) * (i + 0.5) / len(self.rows)
        out = [text(left + self.width / 2, top + 18, self.title, more='font-weight="bold"')]
        for v in self.x.ticks():
            out += [line(X(v), y0, X(v), y1, "#ddd"), text(X(v), y0 + 16, number(v))]
        if self.rows:
            for i, name in enumerate(self.rows):
                out += [line(x0, row(i), x1, row(i), "#ddd"), text(x0 - 8, row(i) + 4, name, "end")]
        else:
            for v in self.y.ticks():
                out += [line(x0, Y(v), x1, Y(v), "#ddd"), text(x0 - 6, Y(v) + 4, number(v), "end")]
            middle = (y0 + y1) / 2
            out.append(text(left + 14, middle, self.y_label, more=f'transform="rotate(-90 {left + 14:.1f} {middle:.1f})"'))
        out.append(text((x0 + x1) / 2, y0 + 34, self.x_label))
        for gx, gy, name in self.guides:
            if gx is True:
                low, high = max(self.x.low, self.y.low), min(self.x.high, self.y.high)
                out += [line(X(low), Y(low), X(high), Y(high), "#888"), text(X(high) - 44, Y(high) + 24, name, "end")]
            elif gx is not None:
                out += [line(X(gx), y0, X(gx), y1, "#000", "3 3"), text(X(gx), y1 - 2, name, more='font-size="10"')]
            else:
                out += [line(x0, Y(gy), x1, Y(gy), "#000", "3 3"), text(x1 - 4, Y(gy) - 4, name, "end", 'font-size="10"')]
        abreast = sum(what == "points" and any(b) for what, _, _, b, _ in self.series)
        for place, (what, _, a, b, kind) in enumerate(self.series):
            grey, dash = GREYS[kind % len(GREYS)], DASHES[kind % len(DASHES)]
            if what == "points":
                for i, (value, span) in enumerate(zip(a, b)):
                    if value is None:
                        continue
                    y = row(i) + (9 * (place - (abreast - 1) / 2) if span else 0)  # intervals beside each other
                    if span:
                        out.append(line(X(span[0]), y, X(span[1]), y, grey, width=2))
                    out.append(marker(MARKERS[kind % len(MARKERS)], X(value), y, grey))
                continue
            if what == "steps":
                path = [(X(a[i + side]), Y(h)) for i, h in enumerate(b) for side in (0, 1)]
            else:
                path = [(X(x), Y(y)) for x, y in zip(a, b) if y is not None]
            at = " ".join(f"{x:.1f},{y:.1f}" for x, y in path)
            dashes = f' stroke-dasharray="{dash}"' if dash else ""
            out.append(f'<polyline points="{at}" fill="none" stroke="{grey}" stroke-width="1.6"{dashes}/>')
            if what == "line":
                out += [marker(MARKERS[kind % len(MARKERS)], x, y, grey) for x, y in path]
        out.append(f'<rect x="{x0:.1f}" y="{y1:.1f}" width="{x1 - x0:.1f}" height="{y0 - y1:.1f}" fill="none" stroke="#000"/>')
        return out

    def legend(self):
        return [(name, what, kind) for what, name, _, _, kind in self.series if name]


def save(path, panels, columns=2):
    """Panels side by side, a common legend of the series of all below them."""
    out, top, total = [], 0, 0
    for first in range(0, len(panels), columns):
        left = 0
        for panel in panels[first:first + columns]:
            out += panel.draw(left, top)
            left += panel.width
        total = max(total, left)
        top += max(panel.height for panel in panels[first:first + columns]) + 6
    entries = list(dict.fromkeys(entry for panel in panels for entry in panel.legend()))
    x, top = 20, top + 12
    for name, what, kind in entries:
        wide = 56 + 6.8 * len(name)
        if x + wide > total and x > 20:
            x, top = 20, top + 20
        grey, dash = GREYS[kind % len(GREYS)], DASHES[kind % len(DASHES)]
        if what != "points":
            out.append(line(x, top - 4, x + 32, top - 4, grey, dash, 1.6))
        if what != "steps":
            out.append(marker(MARKERS[kind % len(MARKERS)], x + 16, top - 4, grey))
        out.append(text(x + 38, top, name, "start"))
        x += wide
    height = top + (14 if entries else 0)
    pathlib.Path(path).write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {total:.0f} {height:.0f}" width="{total:.0f}" '
        f'height="{height:.0f}" font-family="sans-serif" font-size="{SIZE}">\n'
        f'<rect width="{total:.0f}" height="{height:.0f}" fill="white"/>\n' + "\n".join(out) + "\n</svg>\n")
