"""The ports and parameters of docs/datasheet.md are those of the SystemVerilog."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SOURCES = {
    "emax_element": ROOT / "hls/rtl/emax_element.sv",
    "emax_core": ROOT / "hls/rtl/core/emax_core.sv",
    "emax_board": ROOT / "hls/rtl/link/emax_board.sv",
}
DATASHEET = (ROOT / "docs/datasheet.md").read_text()
SCHEDULE = (ROOT / "hls/rtl/generated/emax_distance_schedule.svh").read_text()


def width(bits):
    """'[A+2:0]' -> 'A + 3', as the datasheet writes it."""
    if not bits:
        return "1"
    name, sign, number = re.fullmatch(r"\[(?:(\w*[A-Za-z]\w*)([+-]|(?=:)))?(\d*):0\]", bits).groups()
    more = 1 + int(number or 0) * (-1 if sign == "-" else 1)
    return " + ".join([*([name] if name else []), *([str(more)] if more or not name else [])])


def of_source(text, module):
    """[(port, direction, width)] and [(parameter, default)], in the order of the source."""
    text = re.sub(r"//.*", "", text)
    parameters, ports = re.search(rf"module {module} #\((.*?)\n\) \((.*?)\n\);", text, re.DOTALL).groups()
    parameters = [re.fullmatch(r"parameter int (\w+)\s*= (\w+)", item.strip()).groups() for item in parameters.split(",")]
    ports = [re.fullmatch(r"(in|out)put\s+logic\s+(\[.*\])?\s*(\w+)", item.strip()).groups() for item in ports.split(",")]
    return [(name, direction, width(bits)) for direction, bits, name in ports], parameters


def of_document(text, module):
    """The same of the module's section."""
    section = re.search(rf"^## `{module}`\n(.*?)(?=^## )", text, re.DOTALL | re.MULTILINE)[1]
    ports = re.findall(r"^\| `(\w+)` \| (in|out) \| ([\w +]+) \|", section, re.MULTILINE)
    parameters = re.findall(r"^\| `(\w+)` \| (\d+) \|", section, re.MULTILINE)
    return ports, parameters


class DatasheetTest(unittest.TestCase):
    def faults(self, document=DATASHEET, source=None):
        """The modules in which both differ; `source` takes the place of the element's text."""
        return [module for module, path in SOURCES.items()
                if of_document(document, module)
                != of_source(source if source and module == "emax_element" else path.read_text(), module)]

    def test_ports_and_parameters_agree(self):
        self.assertEqual(self.faults(), [])
        self.assertEqual([len(of_document(DATASHEET, module)[0]) for module in SOURCES], [17, 9, 12])

    def test_latency_agrees(self):
        latency = re.search(r"EMAX_DISTANCE_LATENCY (\d+)", SCHEDULE)[1]
        self.assertEqual(re.findall(r"`EMAX_DISTANCE_LATENCY` \| (\d+)", DATASHEET), [latency])

    def test_faults_of_the_document_are_seen(self):
        for old, new in [("`s_axis_point_tlast` | in", "`s_axis_point_last` | in"),
                         ("`s_axis_point_tlast` | in", "`s_axis_point_tlast` | out"),
                         ("POINT_BITS + 3", "POINT_BITS + 2"), ("in | 640", "in | 320"),
                         ("| `SLOT_BITS` | 4 |", "| `SLOT_BITS` | 5 |"),
                         ("| `m_axis_worst_tready` | in | 1 | |\n", "")]:
            self.assertIn(old, DATASHEET)
            self.assertEqual(self.faults(DATASHEET.replace(old, new)), ["emax_element"], new)

    def test_faults_of_the_source_are_seen(self):
        element = SOURCES["emax_element"].read_text()
        for old, new in [(" s_axis_record_tready,", " record_ready,"), ("[639:0]          s_axis", "[607:0] s_axis"),
                         ("input  logic                  clk,", "input logic clk,\n    input logic enable,"),
                         ("SLOT_BITS  = 4", "SLOT_BITS  = 3")]:
            self.assertIn(old, element)
            self.assertEqual(self.faults(source=element.replace(old, new, 1)), ["emax_element"], new)


if __name__ == "__main__":
    unittest.main()
