"""The results as a table, and what they say about the claims."""

import datetime
import json
import platform
import subprocess
from importlib.metadata import version

HEAD = """# The same drop by others

Written by `benches/peers/run`; what is compared and how: `README.md` beside this file.
{date}, {machine}. {versions}.

| what | setting | A: time of impacts 1, 2, 3 off by, us | A: velocity after them off by, % | A: impacts found of {count} | C: time off by, us | E: energy drift, m g rho0 | CPU s per simulated s | ns per step |
|---|---|---|---|---|---|---|---|---|
"""


HEAD_FIVE = """
## {title}

| what | setting | time of impacts 1 to 5 off by, us | velocity after them off by, % | worst time, us | CPU ms to impact 5 | Touchdown cheaper by | CPU s per simulated s | ns per step |
|---|---|---|---|---|---|---|---|---|
"""
TITLES = {"S": "S: a sprung ring", "T": "T: two ends"}


def number(value):
    return "-" if value is None else f"{value:.2g}"


def parts(errors, index, factor):
    return " / ".join(number(e and e[index] * factor) for e in errors)


def line(row):
    if row["kind"] == "not installed":
        return f"| {row['peer']} | {row['setting']} | not installed | | | | | | |"
    cells = [
        row["peer"],
        row["setting"],
        parts(row["A_errors"], 0, 1e6),
        parts(row["A_errors"], 1, 100.0),
        str(row["A_counted"]),
        parts(row["C_errors"], 0, 1e6),
        number(row["E_energy_drift"]),
        number(row["cpu_per_simulated"]),
        number(row["ns_per_step"]),
    ]
    return "| " + " | ".join(cells) + " |"


def worst(row, index):
    """Of the five impacts; None if one is not there."""
    errors = row.get("errors", [None])
    return None if None in errors else max(e[index] for e in errors)


def factor_five(row, ours):
    """How many times cheaper than `row` the cheapest of ours is whose worst errors are no larger: to
    impact 5 and of the whole run, the smaller. None if there is none, or no error to compare."""
    if worst(row, 0) is None:
        return None
    as_good = [
        it
        for it in ours
        if worst(it, 0) is not None and all(worst(it, k) <= worst(row, k) for k in (0, 1))
    ]
    ratios = [
        row[cost] / min(it[cost] for it in as_good)
        for cost in ("cpu_to_five", "cpu_per_simulated")
        if as_good and cost in row
    ]
    return min(ratios, default=None)


def table_five(variant, rows):
    ours = [row for row in rows if row["kind"] == "ours"]
    lines = []
    for row in rows:
        if row["kind"] == "not installed":
            lines.append(line(row))
            continue
        if row["kind"] != "ours":
            row["factor"] = factor_five(row, ours)
        late = worst(row, 0)
        cells = [
            row["peer"],
            row["setting"],
            parts(row["errors"], 0, 1e6),
            parts(row["errors"], 1, 100.0),
            number(late and late * 1e6),
            number(row["cpu_to_five"] * 1e3),
            number(row.get("factor")),
            number(row.get("cpu_per_simulated")),
            number(row.get("ns_per_step")),
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return HEAD_FIVE.format(title=TITLES[variant]) + "\n".join(lines) + "\n"


def claim_five(variant, rows, ours, numbers):
    """Of Siconos' rows that show all five."""
    factors = [(factor_five(row, ours), row) for row in rows if row["peer"] == "Siconos"]
    text = (
        f"- {TITLES[variant]}, {numbers}: at no larger errors in impacts 1 to 5, 5 times cheaper than "
        "Siconos"
    )
    found = [it for it in factors if it[0]]
    if not found:
        return f"{text}: **not met**, no rows to compare."
    least, row = min(found, key=lambda it: it[0])
    verdict = "met" if least >= 5.0 else "**not met**"
    return f"{text}: {verdict}, {least:.1f} times (Siconos: {row['setting']})."


def claims_five(variant, rows):
    ours = [row for row in rows if row["kind"] == "ours"]
    double = [row for row in ours if " f64" in row["setting"]]
    return [
        claim_five(variant, rows, ours, "f64 and f32"),
        claim_five(variant, rows, double, "f64 alone"),
    ]


def no_worse(ours, theirs):
    """Whether each error of `ours` is at most the one of `theirs`; a missing impact is the worst."""
    pairs = zip(ours["A_errors"], theirs["A_errors"])
    return all(o and (t is None or o[0] <= t[0] and o[1] <= t[1]) for o, t in pairs)


def factor(ours, peers):
    """How many times cheaper one row of `ours` is than each of `peers` at errors that are no worse;
    the least over the peers of the best of ours, with the two rows."""
    worst = None
    for peer in peers:
        candidates = [row for row in ours if no_worse(row, peer)]
        if not candidates:
            return None
        best = min(candidates, key=lambda row: row["cpu_per_simulated"])
        ratio = peer["cpu_per_simulated"] / best["cpu_per_simulated"]
        if worst is None or ratio < worst[0]:
            worst = (ratio, best, peer)
    return worst


def claim(text, limit, found):
    if found is None:
        return f"- {text}: **not met**, no row of ours has errors as small."
    ratio, ours, peer = found
    verdict = "met" if ratio >= limit else "**not met**"
    return (
        f"- {text}: {verdict}, {ratio:.1f} times "
        f"(ours: {ours['setting']}; {peer['peer']}: {peer['setting']})."
    )


def claims(rows, count):
    """Each claim with its measurement. Events and our f64 both err by the rounding of a double only:
    between them cost alone is compared."""
    timed = [row for row in rows if row["kind"] != "not installed"]
    ours = [row for row in timed if row["kind"] == "ours"]
    exact = [row for row in ours if " f64" in row["setting"] and row["setting"].startswith("rigid")]
    rigid = [row for row in ours if row["setting"].startswith("rigid")]
    peers = [row for row in timed if row["kind"] in ("penalty", "time-stepping")]
    events = [row for row in timed if row["kind"] == "events"]
    complete = [row for row in events if row["A_counted"] == count]

    def cheapest(ours, peers):
        best = min(ours, key=lambda row: row["cpu_per_simulated"])
        peer = min(peers, key=lambda row: row["cpu_per_simulated"])
        return peer["cpu_per_simulated"] / best["cpu_per_simulated"], best, peer

    found = [str(row["A_counted"]) for row in rigid]
    all_found = all(row["A_counted"] == count for row in rigid)
    lines = [
        claim(
            "At no larger errors in impacts 1 to 3 of A, 10 times cheaper than any penalty or "
            "time-stepping row",
            10.0,
            factor(rigid, peers),
        ),
        claim("The same with f64 alone", 10.0, factor(exact, peers)),
        claim("1000 times cheaper than scipy's events", 1000.0, cheapest(exact, events)),
    ]
    if complete:
        text = "1000 times cheaper than those of scipy's events that find every bounce"
        lines.append(claim(text, 1000.0, cheapest(exact, complete)))
    else:
        lines.append("- No setting of scipy's events found every bounce.")
    verdict = "met" if all_found else "**not met**"
    lines.append(f"- Rung `rigid` finds every bounce: {verdict}, {', '.join(found)} of {count}.")
    return lines


def output(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout.strip()


def machine():
    model = "unknown processor"
    with open("/proc/cpuinfo", encoding="utf-8") as info:
        for row in info:
            if row.startswith("model name"):
                model = row.split(":", 1)[1].strip()
                break
    return f"{model}, one core of a shared virtual machine, {platform.system()}"


def versions():
    siconos = output("dpkg-query", "-W", "-f", "${Version}", "python3-siconos") or "not installed"
    python = [f"{name} {version(name)}" for name in ("scipy", "numpy", "pymunk")]
    rust = output("rustc", "--version").split(" (")[0]
    return ", ".join([*python, "ode_solvers 0.6.2", f"Siconos {siconos}", rust])


def write(drops, five, count, folder):
    """RESULTS.md and results.json in `folder`; `five`: rows by variant."""
    head = HEAD.format(
        date=datetime.date.today(), machine=machine(), versions=versions(), count=count
    )
    body = "\n".join(line(row) for row in drops) + "\n"
    body += "".join(table_five(name, of) for name, of in five.items())
    lines = claims(drops, count)
    lines += [text for name, of in five.items() for text in claims_five(name, of)]
    text = head + body + "\n## Claims\n\n" + "\n".join(lines) + "\n"
    (folder / "RESULTS.md").write_text(text, encoding="utf-8")
    every = drops + [row for of in five.values() for row in of]
    (folder / "results.json").write_text(json.dumps(every, indent=1) + "\n", encoding="utf-8")
