"""Compares the figures of a run with those of the checked-in baseline.

Figures are {subject: {figure: number}}. A baseline belongs to the versions of the tools that gave
it: {versions: figures}.
"""

import json

# figure -> (share by which it may be worse, whether more of it is worse)
TOLERANCES = {
    "latency": (0, True),
    "multiplications": (0, True),
    "additions": (0, True),
    "delay_bits": (0.03, True),
    "lut": (0.03, True),
    "ff": (0.05, True),
    "dsp": (0, True),
    "ram": (0, True),
    # A figure is of one placement. The same logic, placed anew, gave 159 to 173 MHz.
    "fmax": (0.10, False),
}


def key(versions):
    return ", ".join(f"{tool} {version}" for tool, version in sorted(versions.items()))


def compare(measured, baseline, complete):
    """Faults, one line each: figures worse than the baseline's by more than their tolerance, and
    subjects or figures that only one side has (if the run was complete, also those not measured)."""
    faults = []
    for subject, figures in measured.items():
        for figure, value in figures.items():
            old = baseline.get(subject, {}).get(figure)
            share, more_is_worse = TOLERANCES[figure]
            if old is None:
                faults.append(f"{subject}: {figure} {value:g} is not in the baseline")
                continue
            limit = old * (1 + share if more_is_worse else 1 - share)
            if value > limit if more_is_worse else value < limit:
                faults.append(f"{subject}: {figure} {value:g} is worse than the baseline's {old:g}"
                              f" (limit {limit:g})")
    for subject, figures in baseline.items():
        if subject not in measured and not complete:
            continue
        for figure in figures:
            if figure not in measured.get(subject, {}):
                faults.append(f"{subject}: {figure} is in the baseline but was not measured")
    return faults


def read(path):
    return json.loads(path.read_text()) if path.exists() else {}


def write(path, versions, measured, complete):
    """Makes the measured figures the baseline of these versions; figures of other versions are dropped.
    What an incomplete run did not measure stays as it was."""
    figures = {} if complete else read(path).get(key(versions), {})
    figures.update(measured)
    path.write_text(json.dumps({key(versions): dict(sorted(figures.items()))}, indent=2) + "\n")
