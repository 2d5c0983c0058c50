"""A trace of a netlist, as a waveform in VCD format and as a table of words."""

from .btor import simulate


class Trace:
    """The values of all nodes in each step of a counterexample, computed on numbers alone."""

    def __init__(self, system, steps, inputs, states):
        self.system = system
        self.values = simulate(system, steps, inputs, states)

    def value(self, name, step):
        return self.values[step][self.system.named(name)]

    def names(self):
        """Names of words, not of memories; those of the top first."""
        words = [name for name in self.system.names if isinstance(self.system.nodes[self.system.names[name]].sort, int)]
        return sorted(words, key=lambda name: (name.count("."), name))

    def write_vcd(self, path):
        scopes = {}
        for index, name in enumerate(self.names()):
            *folders, leaf = name.replace("\\", "").replace("$", "_").split(".")
            scopes.setdefault(tuple(folders), []).append((leaf, name, f"s{index}"))
        lines = ["$timescale 1ns $end"]
        for folders, signals in sorted(scopes.items()):
            lines += [f"$scope module {folder} $end" for folder in ("proof", *folders)]
            for leaf, name, code in signals:
                width = self.system.nodes[self.system.names[name]].sort
                lines.append(f"$var wire {width} {code} {leaf.split('[')[0]} $end")
            lines += ["$upscope $end"] * (1 + len(folders))
        lines.append("$enddefinitions $end")
        words, clocks = [], []
        for _, signals in sorted(scopes.items()):
            words += [(self.system.names[name], code) for leaf, name, code in signals if leaf != "clk"]
            # The clock is no signal of the netlist's: a step is one of its edges.
            clocks += [code for leaf, _, code in signals if leaf == "clk"]
        last = {}
        for step, values in enumerate(self.values):
            lines.append(f"#{10 * step}")
            lines += [f"b1 {code}" for code in clocks]
            for number, code in words:
                if last.get(code) != values[number]:
                    last[code] = values[number]
                    lines.append(f"b{values[number]:b} {code}")
            lines.append(f"#{10 * step + 5}")
            lines += [f"b0 {code}" for code in clocks]
        lines.append(f"#{10 * len(self.values)}")
        path.write_text("\n".join(lines) + "\n")

    def table(self):
        """A table of the top's signals, with a row for each signal and a column for each step."""
        rows = [name for name in self.names() if "." not in name and "[" not in name and name != "clk" and not name.endswith("_EN")]
        width = max([len(name) for name in rows], default=0)
        lines = []
        for name in rows:
            digits = (self.system.nodes[self.system.names[name]].sort + 3) // 4
            cells = " ".join(f"{values[self.system.names[name]]:0{digits}x}" for values in self.values)
            lines.append(f"{name:{width}}  {cells}")
        return "\n".join(lines) + "\n"
