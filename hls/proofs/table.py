"""The proofs of `./dev prove`, as data: what holds, by which method, how deep, and the faults that refute it."""

import re
from pathlib import Path

from proving.proof import Fault, Graph, Parts, Proof, Words
from synthesis import designs

DATAPATH = Path("hls/rtl/generated/emax_distance.sv")
FILTER = Path("hls/rtl/filter/generated/emax_filter.sv")
CHECKS = ("checks/check_order.sv", "checks/check_stream.sv", "checks/check_reset.sv")
MANTISSAS = ("mantissas/mantissa_multiply.sv", "mantissas/mantissa_square.sv")
OPERATORS = tuple(f"operators/{name}.sv" for name in ("fp_add", "fp_multiply", "fp_square", "fp_less", "fp_divide", "fp_square_root", "delay_line"))
FIXED_OPERATORS = tuple(f"operators/{name}.sv" for name in ("fixed_add", "fixed_fit", "fixed_less", "fixed_multiply", "fixed_negate", "delay_line"))
PRODUCT = (("mantissas", "product", ("a", "b")),)
ROUNDED_UP = "rounded up to the least normal number"
# Shows the harness one word of a memory, at an address that the harness chooses.
WATCHED_MEMORY = (("block_memory.sv", """  (* keep *) logic [ADDRESS_BITS-1:0] watched_address;
  (* keep *) logic [WIDTH-1:0] watched_word;
  assign watched_word = words[watched_address];"""),)
# Shows the harness the requests that wait in block_answer.
WATCHED_QUEUE = (("block_answer.sv", """  (* keep *) logic [QUEUE_BITS-1:0] watched_place;
  (* keep *) logic [REQUEST-1:0] watched_request;
  assign watched_request = queue[watched_place];
  (* keep *) logic [4*REQUEST-1:0] all_requests;
  assign all_requests = {queue[3], queue[2], queue[1], queue[0]};"""),)

# Shows the harness the version of the link.
SENT_VERSION = (("link_sender.sv", """  (* keep *) logic [7:0] sent_version;
  assign sent_version = VERSION;"""),)

# The latencies of the generated datapath.
LATENCY = {design.top: design.parameters["LATENCY"] for design in designs.operators(DATAPATH, 0)}
ROUNDING = 3  # cycles of a product's latency after the product of the mantissas
MULTIPLYING = LATENCY["fp_multiply"] - ROUNDING


def mutants(*names):
    return tuple(Fault(mutant=name) for name in names)


def operator(name, module, rule, inputs, output, what, faults, parameters=None, files=(), **more):
    words = Words(rule, inputs, output, **{key: more.pop(key) for key in ("exponent", "mantissa", "functions", "without") if key in more})
    return Proof(name, what, "words", module, LATENCY[module], faults,
                 {"LATENCY": LATENCY[module], **(parameters or {})}, files, rule=words, **more)


def stream(name, what, depth, faults, parameters=None, method="induction", harness=None, **more):
    top = f"prove_{harness or name}"
    return Proof(name, what, method, top, depth, faults, parameters or {}, (*CHECKS, f"{top}.sv"), spread=True, **more)


def mantissas(name, module, family, a, b, faults):
    inputs, output = (("a", "b"), "product") if module == "mantissa_multiply" else (("a",), "square")
    widths = {"WIDTH_A": 24, "WIDTH_B": 24} if module == "mantissa_multiply" else {"WIDTH": 24}
    return Proof(name, f"{family}/{module} of 24 bits gives the exact product: the sum of the products of the operands' parts",
                 "split", module, MULTIPLYING, faults, {"LATENCY": MULTIPLYING, **widths}, family=family,
                 rule=Parts(inputs, output, a, b))


WHOLE, AT_17, AT_18 = ((0, 24),), ((0, 17), (17, 7)), ((0, 18), (18, 6))

OPERATOR_PROOFS = [
    operator("fp_less", "fp_less", "less", ("a", "b"), "less", "a < b for all of binary32 is SMT-LIB's fp.lt of the flushed operands",
             mutants("LESS_OR_EQUAL", "LESS_IGNORES_SIGN", "LESS_NAN_IS_ORDERED", "LESS_SUBNORMALS_DIFFER",
                     "LESS_SIGNED_ZEROS_DIFFER")),
    operator("fp_add", "fp_add", "add", ("a", "b"), "sum", "a + b for all of binary32 is SMT-LIB's fp.add, flushed",
             (*mutants("ADD_LOST_STICKY", "ADD_ORDER_BY_EXPONENT", "ADD_SUBNORMAL_OPERAND", "ADD_NO_BORROW", "ADD_TIES_UP",
                       "ADD_ZERO_SIGN", "ADD_NO_FLUSH", "ADD_OVERFLOW_FRACTION"),
              Fault("shift mask without inner parentheses, as Yosys reads it",
                    patch=("fp_add.sv", "~(SHIFT_BITS'(7))", "~SHIFT_BITS'(7)")))),
    operator("fp_subtract", "fp_add", "subtract", ("a", "b"), "sum", "a - b for all of binary32 is SMT-LIB's fp.sub, flushed; x - x is +0",
             (*mutants("ADD_ZERO_SIGN"), Fault("the sign of b is not turned", patch=("fp_add.sv", "b[W-1] ^ SUBTRACT", "b[W-1]"))),
             {"SUBTRACT": 1}),
    operator("fp_multiply", "fp_multiply", "product_of", ("a", "b"), "product",
             "a b for all of binary32 is the exact product rounded once, flushed", functions=PRODUCT, files=MANTISSAS,
             assumes="mantissa_multiply gives the exact product; only its range is used here",
             faults=mutants("MULTIPLY_LOST_STICKY", "MULTIPLY_TIES_UP", "MULTIPLY_TINY_BEFORE_ROUNDING", "MULTIPLY_NO_FLUSH",
                            "MULTIPLY_NO_OVERFLOW", "MULTIPLY_ZERO_BY_INFINITY", "MULTIPLY_SUBNORMAL_OPERAND",
                            "MULTIPLY_NAN_IS_INFINITY")),
    operator("fp_square", "fp_square", "product_of", ("a",), "square",
             "a a for all of binary32 is the exact square rounded once, flushed", functions=PRODUCT, files=MANTISSAS,
             without=(ROUNDED_UP,), assumes="mantissa_square gives the exact square; only its range is used here",
             faults=mutants("SQUARE_SIGN", "MULTIPLY_LOST_STICKY", "MULTIPLY_NO_FLUSH")),
    operator("fp_square_binary16", "fp_square", "square", ("a",), "square",
             "a a for all of binary16, the mantissas' product included, is SMT-LIB's fp.mul, flushed", mutants("SQUARE_SIGN"),
             {"EXPONENT": 5, "MANTISSA": 10}, exponent=5, mantissa=10, without=(ROUNDED_UP,)),
    operator("fp_multiply_binary16", "fp_multiply", "multiply", ("a", "b"), "product",
             "a b for all of binary16, the mantissas' product included, is SMT-LIB's fp.mul, flushed", mutants("MULTIPLY_TIES_UP"),
             {"EXPONENT": 5, "MANTISSA": 10}, exponent=5, mantissa=10, quick=False, limit=3000),
    Proof("mantissa_multiply", "behavioural/mantissa_multiply of 24 bits gives the exact product", "words", "mantissa_multiply",
          MULTIPLYING, (Fault("a bit of b is lost", patch=("mantissa_multiply.sv", "WIDTH'(b)", "WIDTH'(b[WIDTH_B-2:0])")),),
          {"WIDTH_A": 24, "WIDTH_B": 24, "LATENCY": MULTIPLYING}, rule=Words("exact product", ("a", "b"), "product")),
    Proof("mantissa_square", "behavioural/mantissa_square of 24 bits gives the exact square", "words", "mantissa_square",
          MULTIPLYING, (Fault("a bit of a is lost", patch=("mantissa_square.sv", "(2 * WIDTH)'(a) * (2", "(2 * WIDTH)'(a[WIDTH-2:0]) * (2")),),
          {"WIDTH": 24, "LATENCY": MULTIPLYING}, rule=Words("exact product", ("a",), "square")),
    mantissas("mantissa_multiply_ecp5", "mantissa_multiply", "ecp5", AT_18, AT_18,
              mutants("ECP5_MIDDLE_TOO_NARROW", "ECP5_UPPER_ROWS_LOST")),
    mantissas("mantissa_square_ecp5", "mantissa_square", "ecp5", AT_18, AT_18, mutants("ECP5_CROSS_ONCE")),
    mantissas("mantissa_multiply_xilinx", "mantissa_multiply", "xilinx", WHOLE, AT_17,
              (Fault("the cascade loses the low product's top bit",
                     patch=("mantissa_multiply.sv", "low[WIDTH_A+LOW-1:LOW])", "low[WIDTH_A+LOW-2:LOW])")),)),
    mantissas("mantissa_square_xilinx", "mantissa_square", "xilinx", WHOLE, AT_17,
              (Fault("the cascade loses the low product's top bit",
                     patch=("mantissa_multiply.sv", "low[WIDTH_A+LOW-1:LOW])", "low[WIDTH_A+LOW-2:LOW])")),)),
]

CREDIT_FAULTS = (*mutants("CREDIT_NOT_TAKEN", "CREDIT_NOT_GIVEN"),
                 Fault("the two credits that are kept back are lent too", patch=("credit_counter.sv", "credits > 2", "credits > 0")))
FILTER_WORDS = {"LOAD": 6, "MEET": 7, "ASK": 8, "POINT_WORDS": 2, "RECORD_WORDS": 11}
RING_FAULTS = mutants("SLOT_FREED_EARLY", "RING_SKIPS_A_SLOT", "RING_OVERFILLED")
DECODER_FAULTS = (*mutants("ONE_POINT_TOO_MANY", "REDUCE_LEAVES_BLOCK_OPEN"),
                  Fault("a record's words in the wrong order",
                        patch=("command_decoder.sv", "if (next_word[i]) assembled", "if (next_word[RECORD_WORDS-1-i]) assembled")),
                  Fault("a record changes before it is taken",
                        patch=("command_decoder.sv", "if (!own_valid[i/4]) record", "record")),
                  Fault("points are written while the block before is read",
                        patch=("command_decoder.sv", "sequencer_idle && !finish && !drop && !block", "!finish && !drop && !block")),
                  Fault("the first of the faults is answered",
                        patch=("command_decoder.sv", "if (!fits) fault", "if (!fits && fault == '0) fault")),
                  Fault("an answered fault stays", patch=("command_decoder.sv", "fault  <= '0;\n        block", "block")),
                  Fault("records without a block reach the elements", patch=("command_decoder.sv", "block ? RECORD : SKIP", "RECORD")))

STREAM_PROOFS = [
    stream("axis_register", "axis_register: words leave in order, none lost or doubled; tvalid and tdata stay while tready is low; a reset empties it", 1,
           (Fault("the spare word is lost", patch=("axis_register.sv", "arrived || spare_valid;\n      spare", "arrived;\n      spare")),
            Fault("ready in spite of a spare word", patch=("axis_register.sv", "free || !(arrived || spare_valid)", "1'b1"))), reach=8),
    stream("axis_fifo", "axis_fifo and ring_memory: words leave in order, none lost or doubled, within five cycles; a reset empties them", 2,
           mutants("FIFO_IGNORES_STALL"), reach=16, watch=WATCHED_MEMORY),
    stream("credits", "credit_counter, valid_line and axis_fifo as in emax_element: no word meets a full FIFO, no credit is lost (8 credits, line of 4)", 2,
           CREDIT_FAULTS, reach=16),
    stream("credits_of_element", "credits with the sizes of emax_element: 256 credits, a line of 144", 2,
           mutants("CREDIT_NOT_TAKEN"), {"DEPTH_BITS": 8, "LINE": 144}, harness="credits", reach=8, quick=False),
    stream("valid_line", "valid_line of 142: a bit comes out in its cycle, and never one that went in before a reset", 1,
           mutants("VALID_OUTLIVES_RESET"), reach=8),
    stream("record_ring", "record_ring: each record keeps a slot of its own until its last read, 6 cycles after its last pair; records stay in order, none is lost (4 slots)", 2,
           RING_FAULTS, reach=14),
    stream("record_ring_of_element", "record_ring with the sizes of emax_element: 16 slots, a last read after 98 cycles", 2,
           mutants("SLOT_FREED_EARLY"), {"SLOT_BITS": 4, "LAST_READ": 98}, harness="record_ring", reach=24, quick=False),
    stream("credits_of_filter", "credits with the sizes of filter_element: 64 credits, a line of 42", 2,
           mutants("CREDIT_NOT_TAKEN"), {"DEPTH_BITS": 6, "LINE": 42}, harness="credits", reach=8),
    stream("record_ring_of_filter", "record_ring with the sizes of filter_element: 16 slots, a last read after 22 cycles", 2,
           mutants("SLOT_FREED_EARLY"), {"SLOT_BITS": 4, "LAST_READ": 22}, harness="record_ring", reach=24),
    stream("command_ring", "link_command_ring: words of committed frames leave in order, once; words of frames that are rolled back never leave; no word is written without room (8 words)", 2,
           (*mutants("LINK_NO_ROLLBACK", "LINK_COUNTS_BEFORE_CRC"),
            Fault("the room does not count the words that wait", patch=("link_command_ring.sv", "ALL + read_pointer - committed;", "ALL;"))),
           reach=14, watch=WATCHED_MEMORY, assumes="emax_link begins each frame with a rollback, writes no more words than there was room for at that time, and commits in a cycle without write or rollback"),
    stream("answers", "link_answers: a frame stays until the host's `expected` has passed its number; frames are numbered in turn, each word is in exactly one, and those of less than 256 words end with an answer", 1,
           (*mutants("LINK_ANY_ACKNOWLEDGES", "LINK_HEADERS_LEAVE_ALONE"),
            Fault("a header joins a frame that closes", patch=("link_answers.sv", " && !s_axis_answer_tvalid", "")),
            Fault("what is being sent is forgotten", patch=("link_answers.sv", "if (passed && !hold)", "if (passed)")),
            Fault("two frames at a time", patch=("link_answers.sv", "&& !under_way && !closing;", "&& !closing;"))), reach=150, quick=False),
    stream("command_decoder", "command_decoder: any words give the points, records, requests and ends of blocks that docs/protocol.md says, each once and in order", 1,
           DECODER_FAULTS, reach=34,
           assumes="a word waits until it is taken (axis_register), a record is taken only while it is there, and request_ready is low in the cycle of a request"),
    stream("command_decoder_of_three", "command_decoder for three elements, whose last row may be full or not", 1,
           (Fault("points go to one element", patch=("command_decoder.sv", "NUM_PE'({to_element, to_element[NUM_PE-1]})", "to_element")),
            Fault("the last row is taken to be full", patch=("command_decoder.sv", "to_element | (to_element - 1'b1)", "'1")),
            Fault("a block is reduced before its last record is taken",
                  patch=("command_decoder.sv", "request_ready && !assembled_full && !record_valid && !finish", "request_ready && !finish"))),
           {"NUM_PE": 3, "ROW_BITS": 9}, harness="command_decoder", reach=34, quick=False),
    stream("command_decoder_of_filter", "command_decoder for the words of the filtering core", 1, DECODER_FAULTS, FILTER_WORDS,
           harness="command_decoder", reach=34),
    stream("pair_sequencer", "pair_sequencer: each record meets each row of its block once, in order; the last record alone gives a final pair for each point", 1,
           (*mutants("PASS_NOT_PADDED", "PADDING_IS_FINAL", "LAST_RECORD_NOT_HELD", "DROP_IGNORED"),
            Fault("every record is a block's first", patch=("pair_sequencer.sv", "final_pass || dropping_pass;", "1'b1;"))), reach=24,
           assumes="emax_core hands over a record only where all rings have a slot; command_decoder ends a block only after a record of it, and waits for idle before the next record"),
    stream("block_answer", "block_answer: each request has its answer of docs/protocol.md, in order: lists in the order of the points, the greatest distance, the lowest index", 1,
           (*mutants("BLOCK_KEEPS_ANY_OF_EQUALS", "ELEMENTS_OUT_OF_TURN"),
            Fault("an element without points counts as one with points", patch=("block_answer.sv", "32'(count) > p", "32'(count) >= p"))),
           reach=14, watch=WATCHED_QUEUE,
           assumes="command_decoder makes a request only in the cycle after request_ready, and asks for results of 1 to 1,024 points"),
    stream("running_minimum", "running_minimum: each pair's minimum is the least of infinity and the distances that its point has met since its first pair (4 points)", 5,
           mutants("FIRST_IGNORED", "FIRST_WITHOUT_INFINITY", "MINIMUM_WRITTEN_ASIDE", "MINIMUM_NOT_KEPT"), reach=16, watch=WATCHED_MEMORY,
           assumes="emax_element keeps two pairs of one point at least five cycles apart and asserts it"),
    stream("running_minimum_of_filter", "running_minimum of the filtering core, whose points start at all ones", 5,
           mutants("FIRST_IGNORED", "MINIMUM_WRITTEN_ASIDE", "MINIMUM_NOT_KEPT"), {"NOT_MET": 0xffffffff}, harness="running_minimum",
           reach=16, watch=WATCHED_MEMORY, assumes="pair_sequencer keeps two pairs of one point at least five cycles apart"),
    stream("worst_point", "worst_point: two cycles after a block's last value it gives the greatest value and the index of the first that has it", 1,
           mutants("WORST_NEVER_STARTS_ANEW", "WORST_TAKES_LAST_OF_EQUALS"), reach=12),
    stream("sdram_controller", "sdram_controller: each request becomes one READ or WRITE, in order, in its row; each command keeps the chip's times, a refresh comes in time, and the pins say it (two refreshes at the start, one every 600 ns)", 1,
           mutants("SDRAM_MODE_SHORT", "SDRAM_ROW_SHORT", "SDRAM_PRECHARGE_SHORT", "SDRAM_ACTIVE_SHORT", "SDRAM_REFRESH_SHORT",
                   "SDRAM_RECOVERY_SHORT", "SDRAM_BURST_CUT", "SDRAM_KEEPS_ROW", "SDRAM_CLOSES_ITSELF"), reach=38, quick=False),
    stream("frames", "link_sender into link_receiver: a status frame or a notice arrives whole, with the fields it was sent with", 115,
           (Fault("the remainder is not inverted", patch=("link_sender.sv", "word <= ~remainder;", "word <= remainder;")),
            Fault("fields change places", patch=("link_sender.sv", "{header_expected, sequence_number, header_session}",
                                                 "{sequence_number, header_expected, header_session}"))), method="bounded",
           watch=SENT_VERSION),
    stream("uart", "uart_sender into uart_receiver: every byte arrives once, unchanged, within the time of eleven bits (2 clocks a bit)", 60,
           (Fault("bits in the wrong order", patch=("uart_receiver.sv", "{line, bits[7:1]}", "{bits[6:0], line}")),
            Fault("no stop bit", patch=("uart_sender.sv", "bits_left <= 10;", "bits_left <= 9;"))), method="bounded"),
]


def delay(kind, most, what, faults):
    """The proof of the lines of this kind in the generated modules, and of the shortest lines."""
    text = "".join(path.read_text() for file in (DATAPATH, FILTER) for path in sorted(file.parent.glob("*.sv")))
    used = {int(depth) for depth in re.findall(rf'\.DEPTH\((\d+)\), \.STYLE\("{kind}"\)', text)}
    return Proof(f"delay_line_{kind}", f"delay_line in {what} gives each word after as many edges as its depth says, whatever value its counter starts with",
                 "delays", "prove_delay_lines", most, faults,
                 {"MOST": most, "KIND": ["registers", "shift_register", "distributed_ram", "block_ram"].index(kind)},
                 ("prove_delay_lines.sv",), rule=tuple(sorted({1, 2, 3, 4, 5, most} | used)))


CHAIN_SHORT = Fault("one edge short", patch=("delay_line.sv", "stage[DEPTH-1]", "stage[DEPTH-2]"))
DELAY_PROOFS = [
    delay("registers", 8, "registers", (CHAIN_SHORT,)),
    delay("shift_register", 24, "shift registers", (CHAIN_SHORT,)),
    delay("distributed_ram", 40, "distributed RAM", mutants("DELAY_ONE_SHORT")),
    delay("block_ram", 73, "block RAM",
          (Fault("the counter wraps late", patch=("delay_line.sv", "BITS'(WORDS - 1) ? '0", "BITS'(WORDS) ? '0")),)),
]

DATAPATH_PROOFS = [
    Proof("emax_distance", "the generated datapath is the kernel's dataflow graph for all inputs, with the operators as unknown functions",
          "graph", "emax_distance", 142,
          (Fault("a delay is one edge short", patch=(DATAPATH.name, ".DEPTH(40), .STYLE(\"distributed_ram\")) residual12_at_102",
                                                    ".DEPTH(39), .STYLE(\"distributed_ram\")) residual12_at_102")),
           Fault("the operands of a difference change places",
                 patch=(DATAPATH.name, ".a(across13_product), .b(across13_product_2)", ".a(across13_product_2), .b(across13_product)")),
           Fault("a choice takes the wrong branch", patch=(DATAPATH.name, "prefer_upper ? across_upper_at_106 : y_at_106",
                                                          "prefer_upper ? y_at_106 : across_upper_at_106")),
           Fault("NaN counts as greater than zero", patch=(DATAPATH.name, "|z_from_v2[30:23] & ~(&z_from_v2[30:22])", "|z_from_v2[30:23]"))),
          files=OPERATORS, rule=Graph("visible_edge"), assumes="the proofs of the operators and of the delay lines"),
    Proof("emax_filter", "the filter's generated datapath is the dataflow graph of its source for all inputs, with the operators and their parameters as unknown functions",
          "graph", "emax_filter", 50,
          (Fault("a delay is one edge short", patch=(FILTER.name, ".DEPTH(29), .STYLE(\"distributed_ram\")) rounded_dot_at_42",
                                                    ".DEPTH(28), .STYLE(\"distributed_ram\")) rounded_dot_at_42")),
           Fault("the operands of a difference change places",
                 patch=(FILTER.name, ".a(across13_product), .b(across13_product_2)", ".a(across13_product_2), .b(across13_product)")),
           Fault("a segment sees no edge", patch=(FILTER.name, "assign visible12 = visible12_negative | segment;", "assign visible12 = visible12_negative;")),
           Fault("the result wraps around", patch=(FILTER.name, ".SHIFT(0), .WIDTH(33), .HALF_UP(1'b0), .SATURATE(1'b1)",
                                                  ".SHIFT(0), .WIDTH(33), .HALF_UP(1'b0), .SATURATE(1'b0)")),
           Fault("a sum in place of a difference", patch=(FILTER.name, ".SUBTRACT(1'b1), .LATENCY(FIXED_ADD_LATENCY)) z_from_v2",
                                                         ".SUBTRACT(1'b0), .LATENCY(FIXED_ADD_LATENCY)) z_from_v2"))),
          files=FIXED_OPERATORS, rule=Graph("filter"), assumes="the proofs of the delay lines; operators on fixed-point numbers have none"),
]

PROOFS = [*OPERATOR_PROOFS, *DELAY_PROOFS, *DATAPATH_PROOFS, *STREAM_PROOFS]
