"""The designs that are synthesized, their Yosys scripts, and the register shell around them."""

import json
import re
from dataclasses import dataclass, field
from pathlib import Path

from .tools import Failure

RTL = Path("hls/rtl")
GENERATED = RTL / "generated"
FILTER = [RTL / "filter", RTL / "filter/generated", RTL / "fixed"]
ULX3S = Path("hls/boards/ulx3s")


@dataclass
class Design:
    name: str
    top: str
    target: float  # MHz
    parameters: dict = field(default_factory=dict)
    generated: list = None  # in place of the sources in hls/rtl/generated
    more: list = field(default_factory=list)  # sources beside hls/rtl
    replaced: dict = field(default_factory=dict)  # a source, and the file that is read in its place

    def sources(self, family):
        """All of the module library: Yosys keeps what the top uses. A module that the family does not
        map has its behavioural description."""
        mapped = {path.name: path for folder in ("behavioural", family) for path in (RTL / folder).glob("*.sv")}
        sources = [*sorted(RTL.glob("*.sv")), *(mapped[name] for name in sorted(mapped)),
                   *(self.generated or sorted(GENERATED.glob("*.sv"))), *self.more]
        return [self.replaced.get(path, path) for path in sources]

    def inputs(self, family):
        headers = [path for folder in (RTL, GENERATED, *FILTER) for path in sorted(folder.glob("*.svh"))]
        return [*self.sources(family), *headers]


def _write_verilog(select=""):
    """Writes a netlist for simulation, or what `select` selects of it, with signals split whose parts have
    different drivers. To Verilator such a signal is a loop where one part makes another, and Verilator
    5.006 may leave a loop unsettled: a netlist then seems wrong that is right."""
    selected = " -selected" if select else ""
    return (f"design -push-copy; {select}splitnets -driver; "
            f"write_verilog -noattr{selected} {{folder}}/netlist.v; design -pop; ")


# Yosys 0.70 reads this expression as (~SHIFT_BITS)'(7), Verilator and the standard as
# ~(SHIFT_BITS'(7)). The adder had it, so every bitstream computed wrong sums while all simulations of
# the source were right. Every comparison of netlists or front ends is tried on it.
MISREAD = (RTL / "fp_add.sv", "~(SHIFT_BITS'(7))", "~SHIFT_BITS'(7)")


def misread(folder):
    """{source: file with that expression}, the file written into the folder."""
    source, right, wrong = MISREAD
    text = source.read_text()
    if text.count(right) != 1:
        raise Failure(f"{source} holds {right} {text.count(right)} times, not once")
    path = folder / source.name
    folder.mkdir(parents=True, exist_ok=True)
    path.write_text(text.replace(right, wrong))
    return {source: path}


def operators(datapath, target):
    """The floating-point operators with the latencies that the generated datapath uses."""
    text = datapath.read_text()
    constants = dict(re.findall(r"localparam int (\w+) = (\d+);", text))
    used = re.findall(r"^\s*(fp_\w+) #\([^;]*?\.LATENCY\((\w+)\)", text, re.MULTILINE)
    latencies = {module: int(constants.get(latency, latency)) for module, latency in used}
    if not latencies:
        raise Failure(f"{datapath} instantiates no operator fp_... with a LATENCY")
    return [Design(f"{module}, latency {latency}", module, target, {"LATENCY": latency}) for module, latency in sorted(latencies.items())]


def element(target, generated=None):
    return Design("emax_element", "emax_element", target, {"SLOT_BITS": 4}, generated)


def core(elements):
    return Design(f"emax_core, elements: {elements}", "emax_core", 0, {"NUM_PE": elements},
                  more=sorted((RTL / "core").glob("*.sv")))


def filter_core(elements, target):
    """The core of the fixed-point filter, its memories and FIFOs included."""
    core_parts = [RTL / "core" / f"{name}.sv" for name in ("axis_register", "block_answer", "command_decoder", "command_header", "pair_sequencer")]
    more = [*core_parts, *(path for folder in FILTER for path in sorted(folder.glob("*.sv")))]
    return Design(f"filter_core, elements: {elements}", "filter_core", target, {"NUM_PE": elements}, more=more)


def sdram_controller(clock):
    """The controller of the ULX3S's SDRAM at a clock of so many MHz, with registers in the I/O cells."""
    return Design(f"sdram_controller at {clock} MHz", "sdram_controller", clock, {"CLOCK_KHZ": 1000 * clock, "READ_LATENCY": 5},
                  more=[RTL / "core/axis_register.sv", RTL / "sdram/sdram_controller.sv"])


ULX3S_CLOCK = 120  # MHz


def ulx3s(elements, clock=ULX3S_CLOCK, sdram=False):
    """The whole board, its pins included, with a clock of so many MHz, a multiple of 15; with its store in
    block RAM or in the board's SDRAM."""
    folders = [*(RTL / name for name in ("core", "link", "board")), *FILTER, *([RTL / "sdram"] if sdram else [])]
    more = [path for folder in folders for path in sorted(folder.glob("*.sv"))]
    board, top = ("ULX3S with SDRAM", "emax_ulx3s_sdram") if sdram else ("ULX3S", "emax_ulx3s")
    return Design(f"{board} at {clock} MHz, elements: {elements}", top, clock, {"NUM_PE": elements, "CLOCK_MHZ": clock},
                  more=[*more, *sorted(ULX3S.glob("*.sv"))])


def _read(design, family):
    files = " ".join(map(str, design.sources(family)))
    return f"read_verilog -sv -I{RTL} -I{GENERATED} {files}"


def ports_script(design, family):
    """Writes {folder}/ports.json; the parameters that designs set do not change their ports."""
    return f"{_read(design, family)}; hierarchy -top {design.top}; proc; " \
           "write_json {folder}/ports.json"


def _top(netlist):
    (top,) = [module for module in netlist["modules"].values() if "top" in module["attributes"]]
    return top


def ports(path):
    """[(name, direction, width)] of the file's top module."""
    module = _top(json.loads(path.read_text()))
    return [(name, port["direction"], len(port["bits"])) for name, port in module["ports"].items()]


def _instance(design, connections):
    parameters = ", ".join(f".{name}({value})" for name, value in design.parameters.items())
    return f"{design.top} #({parameters}) design ({', '.join(connections)});"


def wrapper(design, ports_of_top):
    """A top that only sets the parameters."""
    declared = ", ".join(f"{direction} [{width - 1}:0] {name}" for name, direction, width in ports_of_top)
    connections = [f".{name}({name})" for name, _, _ in ports_of_top]
    return f"""// Generated for {design.name}.
module synthesis_wrapper ({declared});
  {_instance(design, connections)}
endmodule
"""


def shell(design, ports_of_top):
    """A top with four pins: serial registers hold the inputs and take the outputs, so that pins do
    not limit what fits or how fast it is. Between them and the design stands a rank of registers,
    as the serial chain draws its own together."""
    connections = [".clk(clk)"]
    held = taken = 0
    for name, direction, width in ports_of_top:
        if name == "clk":
            continue
        if direction == "input":
            connections.append(f".{name}(offered[{held + width - 1}:{held}])")
            held += width
        else:
            connections.append(f".{name}(out[{taken + width - 1}:{taken}])")
            taken += width
    return f"""// Generated for {design.name}.
module synthesis_shell (input clk, input capture, input serial_in, output reg serial_out);
  reg [{held - 1}:0] held, offered;
  reg [{taken - 1}:0] given, taken;
  reg capture_now;
  wire [{taken - 1}:0] out;
  (* keep_hierarchy *) {_instance(design, connections)}
  always @(posedge clk) begin
    held <= {{held, serial_in}};
    offered <= held;
    given <= out;
    capture_now <= capture;
    taken <= capture_now ? given : {{taken, 1'b0}};
    serial_out <= taken[{taken - 1}];
  end
endmodule
"""


def _ecp5_mapping(top, options):
    """Synthesis for ECP5 of the design that was read.

    Before flip-flops are mapped, synchronous resets other than aresetn become logic. Yosys infers them
    from multiplexers with a zero. The flip-flops of a tile share such a control signal, which reaches
    them late and spreads the datapath out.
    """
    synthesis = f"synth_ecp5 -top {top} {options}"
    return (f"{synthesis} -run :map_ffs; "
            "select -set by_reset w:*aresetn %co1:+[R,SRST] w:* %d; select -clear; "
            "dffunmap -srst-only t:* @by_reset %d; opt_clean; "
            f"{synthesis} -run map_ffs:; ")


def _in_shell(design, shell_path, family, mapping):
    """The design in its shell. It is mapped with its boundary kept, counted, and then dissolved into the
    shell for placement."""
    return (f"{_read(design, family)} {shell_path}; {mapping}"
            "tee -q -o {folder}/cells.json stat -json; "
            f"{_write_verilog('select c:design %M; ')}"
            "setattr -unset keep_hierarchy c:design; flatten; opt_clean; "
            "write_json {folder}/netlist.json")


def ecp5_script(design, shell_path, options):
    """The design in its shell for ECP5."""
    return _in_shell(design, shell_path, "ecp5", _ecp5_mapping("synthesis_shell", options))


def nexus_script(design, shell_path):
    """The design in its shell for Lattice Nexus. Yosys 0.70 would lose a register that two multipliers share
    (docs/decisions/0048-a-filter-on-nexus.md); with -nodsp it leaves alone those that the mapping names."""
    return _in_shell(design, shell_path, "nexus", "synth_nexus -family lifcl -nodsp -top synthesis_shell; ")


NEXUS_DEVICE = "LIFCL-40-9BG400C"
# nextpnr wants a place for every pin of a Nexus.
NEXUS_PINS = {"clk": "L13", "capture": "G14", "serial_in": "G15", "serial_out": "E17"}


def nexus_constraints():
    return "".join(f"ldc_set_location -site {{{site}}} [get_ports {pin}]\n"
                   f"ldc_set_port -iobuf {{IO_TYPE=LVCMOS33}} [get_ports {pin}]\n" for pin, site in NEXUS_PINS.items())


def _read_with_parameters(design, family):
    parameters = " ".join(f"-set {name} {value}" for name, value in design.parameters.items())
    return f"{_read(design, family)}; chparam {parameters} {design.top}; "


# Registers that are the same everywhere, so that each is near what it controls: the `reset` of a module, and
# those named own_... Yosys would make one of all of them, whose net crosses the device.
OWN_REGISTERS = "select -set own w:reset w:own_* %u %ci1:+$dff[Q] t:$dff %i; setattr -set keep 1 @own; select -clear; "


def top_script(design, options):
    """A design for ECP5 without a shell: a core, a board."""
    return (f"{_read_with_parameters(design, 'ecp5')}hierarchy -top {design.top}; rename -top {design.top}; proc; {OWN_REGISTERS}"
            f"{_ecp5_mapping(design.top, options)}"
            f"{_write_verilog()}write_json {{folder}}/netlist.json")


def words_script(design):
    """What the front end makes of a design before anything is mapped: operations on words."""
    return f"{_read_with_parameters(design, 'behavioural')}prep -flatten -top {design.top}; {_write_verilog()}"


def mutants_script(design, mutants, seed):
    """Maps a design to single gates and lists `mutants` faults, as Yosys's commands that put them in. The
    module then has an input mutant_select for the number of the active fault, from 1 on, or 0 for
    none."""
    return (f"{_read_with_parameters(design, 'behavioural')}synth -flatten -top {design.top}; "
            f"mutate -list {mutants} -seed {seed} -none -ctrl mutant_select {mutants.bit_length()} 0 "
            "-o {folder}/mutants.txt; write_rtlil {folder}/gates.il")


def mutated_script(gates, mutants):
    """Puts the listed faults into the gates."""
    return f"read_rtlil {gates}; script {mutants}; opt_clean; {_write_verilog()}"


def xilinx_script(design, wrapper_path, family):
    return (f"{_read(design, 'xilinx')} {wrapper_path}; "
            f"synth_xilinx -family {family} -flatten -noiopad -noclkbuf -top synthesis_wrapper; "
            f"{_write_verilog()}write_json {{folder}}/netlist.json")


def xilinx_figures(netlist):
    """Cells of the only module that has any, counted as the family's resources; and the numbers of LUTs
    as SRL, of LUTs as RAM, and of DSP blocks with a register behind the multiplier and with registers at
    both inputs."""
    top = _top(json.loads(netlist.read_text()))
    counts, registered, registered_inputs = {}, 0, 0
    for cell in top["cells"].values():
        kind = cell["type"]
        counts[kind] = counts.get(kind, 0) + 1
        if kind.startswith("DSP48"):
            value = lambda name: int(cell["parameters"].get(name, "0"), 2)
            registered += bool(value("MREG") or value("PREG"))
            registered_inputs += bool(value("AREG") and value("BREG"))
    total = lambda pattern: sum(n for kind, n in counts.items() if re.fullmatch(pattern, kind))
    # A RAM32M or RAM64M is four LUTs, a RAM32X1D or RAM64X1D two.
    ram_luts = 4 * total("RAM(32|64)M") + 8 * total("RAM(32|64)M16") + 2 * total("RAM(32|64)X1D")
    return {
        "lut": total("LUT[1-6]|INV") + total("SRL16E?|SRLC32E") + ram_luts,
        "ff": total("FD[RSCP]E"),
        "dsp": total("DSP48E[12]"),
        "ram": total("RAMB.*"),
    }, {"srl": total("SRL16E?|SRLC32E"), "ram_luts": ram_luts, "registered": registered,
       "registered_inputs": registered_inputs}


def _placed(report, log):
    """nextpnr's report, its counts of cells, the figures in it and in its log, and the critical path."""
    luts = re.search(r"Total LUT4s:\s+(\d+)/", log.read_text())
    if luts is None:
        raise Failure(f"{log} does not say how many LUT4s there are")
    report = json.loads(report.read_text())
    used = {kind: counts["used"] for kind, counts in report["utilization"].items()}
    clock = max(report["fmax"], key=lambda name: report["fmax"][name]["constraint"])
    figures = {
        "lut": int(luts[1]),
        "ff": used["TRELLIS_FF"],
        "dsp": used.get("MULT18X18D", 0),
        "ram": used.get("DP16KD", 0),
        "fmax": round(report["fmax"][clock]["achieved"], 2),
    }
    return report, used, figures, _critical_path(report, clock)


def ecp5_figures(report, log, cells):
    """Figures and critical path, from nextpnr's report and log. Yosys's count of the shell's cells is
    subtracted."""
    _, used, figures, path = _placed(report, log)
    (shell_cells,) = [m["num_cells_by_type"] for name, m in json.loads(cells.read_text())["modules"].items()
                      if name == "\\synthesis_shell"]
    figures["lut"] -= shell_cells.get("LUT4", 0)
    figures["ff"] -= shell_cells.get("TRELLIS_FF", 0)
    return figures, {"cells": used["TRELLIS_COMB"] - shell_cells.get("LUT4", 0), "path": path}


def nexus_figures(report, cells):
    """As ecp5_figures; the multipliers are those of Yosys's count."""
    report = json.loads(report.read_text())
    used = {kind: counts["used"] for kind, counts in report["utilization"].items()}
    counted = {name: m["num_cells_by_type"] for name, m in json.loads(cells.read_text())["modules"].items()}
    shell = counted.pop("\\synthesis_shell")
    of_shell = lambda *kinds: sum(shell.get(kind, 0) for kind in kinds)
    clock = max(report["fmax"], key=lambda name: report["fmax"][name]["constraint"])
    figures = {
        "lut": used["OXIDE_COMB"] - of_shell("LUT4"),
        "ff": used["OXIDE_FF"] - of_shell("FD1P3IX", "FD1P3DX"),
        "dsp": sum(kinds.get("MULT18X18", 0) for kinds in counted.values()),
        "ram": used.get("OXIDE_EBR", 0),
        "fmax": round(report["fmax"][clock]["achieved"], 2),
    }
    return figures, {"cells": figures["lut"], "path": _critical_path(report, clock)}


def promised(log):
    """What nextpnr's log expects of a placement: the clock, in MHz, and the length of its wires."""
    text = log.read_text()
    clocks = re.findall(r"^Info: Max frequency for clock .*: ([\d.]+) MHz \(\w+ at ([\d.]+) MHz\)", text, re.MULTILINE)
    lengths = re.findall(r"wirelen = (\d+)", text)
    if not clocks or not lengths:
        raise Failure(f"{log} does not say what clock and what length of wires are expected")
    expected, _ = max(clocks, key=lambda clock: float(clock[1]))
    return float(expected), int(lengths[-1])


def board_figures(report, log):
    """Figures of a whole device, its critical path, and the used and available cells of each kind."""
    report, used, figures, path = _placed(report, log)
    kinds = {"TRELLIS_COMB": "cells", "TRELLIS_FF": "FF", "MULT18X18D": "DSP", "DP16KD": "RAM",
             "EHXPLLL": "PLL", "TRELLIS_IO": "pins", "IOLOGIC": "pins' registers"}
    return figures, {"path": path, "utilisation": {
        name: [used[kind], report["utilization"][kind]["available"]] for kind, name in kinds.items() if kind in used}}


def _critical_path(report, clock):
    for path in report["critical_paths"]:
        if clock in path["from"] and clock in path["to"]:
            steps = path["path"]
            logic = sum(step["delay"] for step in steps if step["type"] != "routing")
            routing = sum(step["delay"] for step in steps if step["type"] == "routing")
            return {"from": readable(steps[0]["from"]["cell"]), "to": readable(steps[-1]["to"]["cell"]),
                    "logic": round(logic, 2), "routing": round(routing, 2),
                    "levels": sum(step["type"] == "logic" for step in steps)}
    return None


def readable(cell):
    """The source's name in a cell's name: design.a.b in "design.a.b_TRELLIS_FF_Q_3_DI_LUT4_Z"."""
    return re.sub(r"_(TRELLIS|LUT4|CCU2|PFUMX|L6MUX|MULT18|DPR16|L7MUX|DP16|FD1P3|WIDEFN9|PDPSC16)\w*(\$\w+)?.*$", "",
                  cell).removeprefix("design.")
