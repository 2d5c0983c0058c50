"""The power of a routed design on an ECP5-85F, estimated (docs/decisions/0054-power-by-comparison.md)."""

CORE, AUXILIARY = 1.1, 2.5  # V
# Typical, of an LFE5U-85F that has no clock (Lattice FPGA-DS-02012, static supply current): A.
STATIC_CORE, STATIC_AUXILIARY = 0.212, 0.026

# Core currents of an iCE40 UP5K, 40 nm as the ECP5, as tinyVision.ai measured them (github.com/tinyvision-ai-inc/ice40_power):
# A for a MHz.
MEASURED_AT = 1.219  # V
CELLS_OF_MEASURED = 5280
CLOCK_NET = (2184e-6 - 645e-6) / (48 - 12) / CELLS_OF_MEASURED  # the same counter at two clocks: for each cell there is
IDLE_CELL = (641.3e-6 - 613.5e-6) / 12 / (228 - 32)  # counters, most of whose bits rest
BUSY_CELL = (996e-6 - 645e-6) / 12 / (208 - 28)  # a multiplier of logic, with new factors in every cycle
BUSY_BLOCK = (882e-6 - 645e-6) / 12  # the same as a block, with its counters


def estimated(utilisation, clock):
    """W when idle and W when every element is at work, for {resource: (used, there)} and a clock in MHz.

    A cell is a lookup table with a flip-flop. A block RAM counts as a multiplier, as none was measured.
    """
    used = {name: count for name, (count, _) in utilisation.items()}
    cells, cells_there = max(used["cells"], used["FF"]), utilisation["cells"][1]
    static = STATIC_CORE * CORE + STATIC_AUXILIARY * AUXILIARY

    def with_current(of_a_mhz):
        return static + CORE * (CORE / MEASURED_AT) * clock * of_a_mhz

    return (with_current(CLOCK_NET * cells_there + IDLE_CELL * cells),
            with_current(CLOCK_NET * cells_there + BUSY_CELL * cells + BUSY_BLOCK * (used["DSP"] + used["RAM"])))
