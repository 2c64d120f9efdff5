#!/usr/bin/python3
"""Checks that the claims of docs/performance.md follow its tables.

A row of a table with the columns "budget" and "measured" says in "kept" whether it keeps its budget: yes or no, computed from
the numbers of the row. The prose may claim that all budgets are kept only if no row says no; the sentences "N of M rows keep
their budget" and "Over budget: `row`, `row`." have to be true, and have to be there if a row says no. Columns that follow from
others (ratio, ns a voxel, bytes a voxel) have to agree with them. Prints each breach as FILE:LINE and exits with 1 if there is one.

Usage: check_performance.py [--write] [FILE]    default docs/performance.md; --write fills in the column "kept" and both sentences,
also in the bench.md that tools/dev/bench.sh writes
Parts of a budget, all of which have to hold: "20 s", "1 GB" (at most), "1.1x of NAME's time" (at most that share of the
rival's), "5x of NAME", "10x under NAME" (the rival takes at least that often as long), "at most 4x slower of NAME"."""
import pathlib
import re
import sys

NUMBER = r"(\d+(?:\.\d+)?)"
UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "GB": 1e9, "MB": 1e6}
ALL_KEPT = re.compile(r"\b(?:every|all|each)\b[^.;:|]{0,30}\bbudgets?\b[^.;:|]{0,30}\b(?:kept|met|held)\b"
                      r"|\b(?:every|all|each)\b[^.;:|]{0,30}\bkeeps? (?:its|their) budgets?\b|\bkeeps? (?:every|all|each)\b[^.;:|]{0,20}\bbudgets?\b|\bwithin (?:every|all|its|their)\b[^.;:|]{0,20}\bbudgets?\b"
                      r"|\bno (?:row|budget)\b[^.;:|]{0,30}\b(?:over|exceeds?|exceeded|missed)\b", re.I)
COUNT = re.compile(r"(\d+) of (\d+) rows keep their budget")
OVER = re.compile(r"Over budget: ((?:`[^`]+`(?:, | and )?)+)\.")


class Table:
    """Rows of cells, with the number of the line each is on."""

    def __init__(self, header):
        self.columns, self.rows = header, []

    def cell(self, cells, column):
        at = self.columns.index(column)
        return cells[at] if at < len(cells) else ""


def tables_of(lines):
    tables, table = [], None
    for number, line in enumerate(lines, 1):
        if not line.startswith("|"):
            table = None
            continue
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if table is None:
            table = Table(cells)
            tables.append(table)
        elif not set(line) <= set("|-: "):
            table.rows.append((number, cells))
    return tables


def quantity(text, units):
    """The first number with one of the units, in seconds or bytes, and by how much rounding may have changed it; None without."""
    match = re.search(NUMBER + r" (" + "|".join(units) + r")\b", text)
    if not match:
        return None
    return float(match.group(1)) * UNITS[match.group(2)], rounding(match.group(1)) * UNITS[match.group(2)]


def rounding(digits):
    return 0.5 * 10.0 ** -len(digits.partition(".")[2])


def kept(budget, measured, rival):
    """True or False, or None where the row has no number to say so (a rival that is not installed)."""
    seconds, size, rivals = quantity(measured, ("s", "ms", "us")), quantity(measured, ("GB", "MB")), quantity(rival, ("s", "ms", "us"))
    verdicts = []
    for part in budget.split(","):
        words = part.strip()
        relative = re.match(r"(at most )?" + NUMBER + r"x (slower of|under|of) (.*)$", words)
        if relative:
            if not seconds or not rivals:
                return None
            times = float(relative.group(2))
            faster = rivals[0] / seconds[0]
            slower_allowed = relative.group(1) or relative.group(4).endswith("'s time")
            verdicts.append(faster >= 1 / times if slower_allowed else faster >= times)
        elif quantity(words, ("s", "ms")) or quantity(words, ("GB", "MB")):
            limit, value = (quantity(words, ("s", "ms")), seconds) if quantity(words, ("s", "ms")) else (quantity(words, ("GB", "MB")), size)
            if not value:
                return None
            verdicts.append(value[0] <= limit[0])
        else:
            return None
    return all(verdicts)


def near(stated, least, most):
    """True if a number as printed may be a value between the two."""
    digits = re.search(NUMBER, stated).group(1)
    return least - rounding(digits) <= float(digits) <= most + rounding(digits)


def ratio_breach(budget, measured, rival, ratio):
    seconds, rivals = quantity(measured, ("s", "ms", "us")), quantity(rival, ("s", "ms", "us"))
    if not re.match(NUMBER + "x$", ratio) or not seconds or not rivals:
        return ""
    (a, da), (b, db) = (seconds, rivals) if "'s time" in budget else (rivals, seconds)
    if near(ratio, (a - da) / (b + db), (a + da) / max(b - db, 1e-12)):
        return ""
    return f"the ratio {ratio} is not that of {measured} and {rival}"


def growth_breaches(table, cells):
    voxels = float(table.cell(cells, "active voxels"))
    for column, per, unit in (("seconds", "ns a voxel", 1e9), ("peak memory (MB)", "bytes a voxel", 1e6)):
        value = table.cell(cells, column)
        least, most = [(float(value) + sign * rounding(value)) * unit / voxels for sign in (-1, 1)]
        if not near(table.cell(cells, per), least, most):
            yield f"{table.cell(cells, per)} {per} is not {value} over {voxels:.0f}"


def verdict_of(table, cells):
    return kept(*(table.cell(cells, column) for column in ("budget", "measured", "rival")))


def budget_tables(lines):
    return [table for table in tables_of(lines) if {"budget", "measured", "rival"} <= set(table.columns)]


def check(path):
    lines = path.read_text().splitlines()
    breaches, said, over, rows = [], [], [], 0
    for table in budget_tables(lines):
        for number, cells in table.rows:
            name, truth = cells[0], verdict_of(table, cells)
            if truth is None and "not installed" not in table.cell(cells, "rival"):
                breaches.append((number, f"{name}: the budget \"{table.cell(cells, 'budget')}\" and what was measured cannot be compared"))
                continue
            rows += truth is not None
            over += [name] if truth is False else []
            mark = table.cell(cells, "kept") if "kept" in table.columns else ""
            wanted = {True: "yes", False: "no", None: ""}[truth]
            if mark != wanted:
                breaches.append((number, f"{name}: kept \"{mark}\", but the numbers of the row say \"{wanted}\""))
            if "ratio" in table.columns:
                wrong = ratio_breach(*(table.cell(cells, column) for column in ("budget", "measured", "rival", "ratio")))
                if wrong:
                    breaches.append((number, f"{name}: {wrong}"))
    for table in tables_of(lines):
        if {"active voxels", "seconds", "peak memory (MB)", "ns a voxel", "bytes a voxel"} <= set(table.columns):
            breaches += [(number, f"{cells[0]}: {words}") for number, cells in table.rows for words in growth_breaches(table, cells)]
    if rows == 0:
        breaches.append((1, "no table with the columns budget, measured and rival"))
    # Sentences run over several lines; a match is told by the line it begins on.
    prose = "\n".join("" if line.startswith(("|", "```")) else line for line in lines)
    prose = re.sub(r"(?<!\n)\n(?!\n)", " ", prose)
    line_of = lambda at: text_line(lines, prose[at:at + 25])
    for match in ALL_KEPT.finditer(prose):
        if over:
            breaches.append((line_of(match.start()), f"\"{match.group(0)}\", but these rows exceed theirs: {', '.join(over)}"))
    for match in COUNT.finditer(prose):
        said.append("count")
        if (int(match.group(1)), int(match.group(2))) != (rows - len(over), rows):
            breaches.append((line_of(match.start()), f"\"{match.group(0)}\": {rows - len(over)} of {rows} do"))
    for match in OVER.finditer(prose):
        said.append("over")
        if re.findall(r"`([^`]+)`", match.group(1)) != over:
            breaches.append((line_of(match.start()), f"\"{match.group(0)}\": it is {', '.join(over) or 'none'}"))
    speaks = any(line and not line.startswith(("#", "Machine: ")) for line in prose.splitlines())  # bench.md has tables alone
    if speaks and over and sorted(set(said)) != ["count", "over"]:
        breaches.append((1, "rows exceed their budget; say \"N of M rows keep their budget. Over budget: `row`, ...\""))
    for number, words in sorted(breaches):
        print(f"{path}:{number}: {words}")
    if not breaches:
        print(f"{rows} rows, {len(over)} over budget, and the prose says so")
    return 1 if breaches else 0


def text_line(lines, beginning):
    first = beginning.split()[:2]
    return next((number for number, line in enumerate(lines, 1) if " ".join(first) in line), 1)


def write(path):
    """Fills in the column, and the two sentences where they stand."""
    lines = path.read_text().splitlines()
    rows, over = 0, []
    for table in budget_tables(lines):
        column = table.columns.index("kept") if "kept" in table.columns else None
        place = column if column is not None else table.columns.index("ratio") + 1 if "ratio" in table.columns else len(table.columns)

        def put(number, word):
            cells = [cell.strip() for cell in lines[number - 1].strip().strip("|").split("|")]
            cells[place:place + (column is not None)] = [word]
            lines[number - 1] = "| " + " | ".join(cells) + " |"

        for number, cells in table.rows:
            truth = verdict_of(table, cells)
            rows += truth is not None
            over += [cells[0]] if truth is False else []
            put(number, {True: "yes", False: "no", None: ""}[truth])
        if column is None and table.rows:
            put(table.rows[0][0] - 2, "kept")
            put(table.rows[0][0] - 1, "---")
            lines[table.rows[0][0] - 2] = lines[table.rows[0][0] - 2].replace(" ", "")
    text = COUNT.sub(f"{rows - len(over)} of {rows} rows keep their budget", "\n".join(lines) + "\n")
    if over:
        text = OVER.sub("Over budget: " + ", ".join(f"`{name}`" for name in over) + ".", text)
    path.write_text(text)


def main(words):
    files = [word for word in words if not word.startswith("--")]
    path = pathlib.Path(files[0]) if files else pathlib.Path(__file__).resolve().parents[2] / "docs" / "performance.md"
    if "--write" in words:
        write(path)
    return check(path)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
