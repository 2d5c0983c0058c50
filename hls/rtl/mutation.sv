// The mutants of the mutation build, one a line: its number, its name, its fault. The active one is
// chosen at run time with +mutant=NUMBER; 0 is the unchanged design.
`ifdef EMAX_MUTATION
/* verilator lint_off DECLFILENAME */  // one list beside mutation.svh
/* verilator lint_off UNUSEDPARAM */  // a design uses its own part of the list
package emax_mutation;
  int active /*verilator public_flat_rw*/ = 0;

  localparam int ADD_LOST_STICKY = 1;  // fp_add: bits shifted out in alignment do not reach rounding
  localparam int ADD_ORDER_BY_EXPONENT = 2;  // fp_add: operands ordered by exponent alone
  localparam int ADD_SUBNORMAL_OPERAND = 3;  // fp_add: a zero or subnormal operand has a hidden bit
  localparam int ADD_NO_BORROW = 4;  // fp_add: bits shifted out borrow nothing from a difference
  localparam int ADD_TIES_UP = 5;  // fp_add: ties round away from zero, not to even
  localparam int ADD_ZERO_SIGN = 6;  // fp_add: x - x has the sign of x
  localparam int ADD_NO_FLUSH = 7;  // fp_add: a sum below the normal range is not flushed
  localparam int ADD_OVERFLOW_FRACTION = 8;  // fp_add: an overflow by carry keeps its fraction
  localparam int MULTIPLY_LOST_STICKY = 21;  // fp_multiply: the product's low half does not reach rounding
  localparam int MULTIPLY_TIES_UP = 22;  // fp_multiply: ties round away from zero, not to even
  localparam int MULTIPLY_TINY_BEFORE_ROUNDING = 23;  // fp_multiply: flushed when tiny before rounding
  localparam int MULTIPLY_NO_FLUSH = 24;  // fp_multiply: an exponent below zero wraps around
  localparam int MULTIPLY_NO_OVERFLOW = 25;  // fp_multiply: an exponent past infinity's is kept
  localparam int MULTIPLY_ZERO_BY_INFINITY = 26;  // fp_multiply: zero times infinity is infinity
  localparam int MULTIPLY_SUBNORMAL_OPERAND = 27;  // fp_multiply: a subnormal operand counts as normal
  localparam int MULTIPLY_NAN_IS_INFINITY = 28;  // fp_multiply: a NaN's fraction is not looked at
  localparam int SQUARE_SIGN = 31;  // fp_square: keeps its operand's sign
  localparam int LESS_OR_EQUAL = 41;  // fp_less: compares with <= instead of <
  localparam int LESS_IGNORES_SIGN = 42;  // fp_less: negative numbers compare as positive ones
  localparam int LESS_NAN_IS_ORDERED = 43;  // fp_less: a NaN compares as beyond infinity
  localparam int LESS_SUBNORMALS_DIFFER = 44;  // fp_less: subnormals do not count as zero
  localparam int LESS_SIGNED_ZEROS_DIFFER = 45;  // fp_less: -0 < +0
  localparam int DELAY_ONE_SHORT = 61;  // delay_line: lines in distributed RAM are one edge short
  localparam int FIELD_ALWAYS_WRITTEN = 62;  // field_memory: writes without write_enable
  localparam int ECP5_MIDDLE_TOO_NARROW = 71;  // ecp5/mantissa_multiply: the middle sum loses its carry
  localparam int ECP5_UPPER_ROWS_LOST = 72;  // ecp5/small_multiply: the last two rows are not added
  localparam int ECP5_CROSS_ONCE = 73;  // ecp5/mantissa_square: the cross product counts once

  localparam int DIVIDE_SUBNORMAL_OPERAND = 81;  // division/fp_divide: a subnormal operand counts as normal
  localparam int DIVIDE_ZERO_BY_ZERO = 82;  // division/fp_divide: zero by zero is infinite
  localparam int DIVIDE_TRUNCATES = 83;  // division/fp_divide: rounds towards zero
  localparam int DIVIDE_NO_FLUSH = 84;  // division/fp_divide: half of the smallest normal number is kept
  localparam int DIVIDE_NO_OVERFLOW = 85;  // division/fp_divide: an exponent past infinity's is kept
  localparam int ROOT_NOT_DOUBLED = 91;  // division/fp_square_root: the mantissa of an odd exponent is not doubled
  localparam int ROOT_SUBNORMAL_OPERAND = 92;  // division/fp_square_root: a subnormal operand counts as normal
  localparam int ROOT_OF_NEGATIVE = 93;  // division/fp_square_root: a negative number counts as positive
  localparam int ROOT_TRUNCATES = 94;  // division/fp_square_root: rounds towards zero

  localparam int FIXED_ROUNDS_DOWN = 131;  // fixed/fixed_fit: halves and what lies above are cut off
  localparam int FIXED_WRAPS = 132;  // fixed/fixed_fit: numbers beyond the ends wrap around
  localparam int FIXED_ENDS_SWAPPED = 133;  // fixed/fixed_fit: beyond an end come -1 and 0
  localparam int FIXED_ADD_UNSIGNED = 134;  // fixed/fixed_add: b counts as positive
  localparam int FIXED_MAGNITUDE_KEPT = 135;  // fixed/fixed_negate: a negative number's magnitude is itself
  localparam int FIXED_ONES_COMPLEMENT = 136;  // fixed/fixed_negate: complements without adding one
  localparam int FIXED_LESS_OR_EQUAL = 137;  // fixed/fixed_less: compares with <= instead of <
  localparam int FIXED_LESS_UNSIGNED = 138;  // fixed/fixed_less: a counts as positive

  localparam int STREAM_ALWAYS_READY = 141;  // stream/pipeline_stream: takes samples without room
  localparam int STREAM_LAST_LOST = 142;  // stream/pipeline_stream: no result is marked as the last
  localparam int STREAM_WITHOUT_RECORD = 143;  // stream/record_stream: takes samples without a record
  localparam int STREAM_KEEPS_RECORD = 144;  // stream/record_stream: a record is never over
  localparam int STREAM_RECORD_EARLY = 145;  // stream/record_stream: the next record's words are written

  localparam int FILTER_AXES_SWAPPED = 151;  // filter/filter_element: y and z of a point change places
  localparam int FILTER_SEGMENT_LOST = 152;  // filter/filter_element: no record is a segment
  localparam int FILTER_FINAL_IGNORED = 153;  // filter/filter_element: every minimum comes out
  localparam int FILTER_LAST_LOST = 154;  // filter/filter_element: the last beat of a block is not marked

  localparam int CREDIT_NOT_TAKEN = 101;  // credit_counter: a beat enters without taking its credit
  localparam int CREDIT_NOT_GIVEN = 102;  // credit_counter: credits do not come back
  localparam int FIFO_IGNORES_STALL = 103;  // ring_memory: the output moves on before its word is taken
  localparam int VALID_OUTLIVES_RESET = 104;  // valid_line: what is in flight survives a reset
  localparam int SLOT_FREED_EARLY = 105;  // record_ring: a slot is free before its last skewed read
  localparam int RING_SKIPS_A_SLOT = 106;  // record_ring: advances by two slots
  localparam int RING_OVERFILLED = 107;  // record_ring: takes records into a full ring
  localparam int FIRST_IGNORED = 108;  // running_minimum: a new block goes on with the old minimum
  localparam int FIRST_WITHOUT_INFINITY = 109;  // running_minimum: the first distance counts, even NaN
  localparam int MINIMUM_WRITTEN_ASIDE = 110;  // running_minimum: written at the next pair's index
  localparam int MINIMUM_NOT_KEPT = 111;  // running_minimum: the latest distance is written instead
  localparam int WORST_NEVER_STARTS_ANEW = 112;  // worst_point: the block before goes on counting
  localparam int WORST_TAKES_LAST_OF_EQUALS = 113;  // worst_point: compares with >= instead of >
  localparam int FINAL_IGNORED = 114;  // emax_element: every minimum comes out
  localparam int LAST_LOST = 115;  // emax_element: the last beat of a block is not marked
  localparam int EDGES_SWAPPED = 116;  // emax_element: fields of edge13 and edge23 change places

  localparam int ONE_POINT_TOO_MANY = 121;  // core/command_header: takes a block of 1,025 points
  localparam int REDUCE_LEAVES_BLOCK_OPEN = 122;  // core/command_decoder: a block can be reduced twice
  localparam int PASS_NOT_PADDED = 123;  // core/pair_sequencer: a point's pairs follow too closely
  localparam int PADDING_IS_FINAL = 124;  // core/pair_sequencer: rows beyond the points come out
  localparam int LAST_RECORD_NOT_HELD = 125;  // core/pair_sequencer: no pass is the final one
  localparam int DROP_IGNORED = 126;  // core/pair_sequencer: records of a block given up stay
  localparam int BLOCK_KEEPS_ANY_OF_EQUALS = 127;  // core/block_answer: the first element's worst stays
  localparam int ELEMENTS_OUT_OF_TURN = 128;  // core/block_answer: one element gives the whole list

  localparam int STORE_KEEPS_OLD_WORDS = 161;  // board/command_store: nothing is written
  localparam int STORE_READS_THE_NEXT = 162;  // board/command_store: a piece begins a word late
  localparam int ROUTER_MIXES_ANSWERS = 163;  // board/command_router: the filter's answers go first
  localparam int STORE_OVERTAKES = 164;  // board/command_store: words pass those that the memory owes
  localparam int STORE_KEEPS_STALE_WORDS = 165;  // board/command_store: words of before a reset come after it

  localparam int SDRAM_STARTS_EARLY = 171;  // sdram/sdram_controller: the first command comes in half of the time
  localparam int SDRAM_FEW_REFRESHES = 172;  // sdram/sdram_controller: one refresh at the start
  localparam int SDRAM_MODE_LEFT_OUT = 173;  // sdram/sdram_controller: the mode is not loaded
  localparam int SDRAM_MODE_SHORT = 174;  // sdram/sdram_controller: a command a cycle too early after LOAD MODE (tMRD)
  localparam int SDRAM_ROW_SHORT = 175;  // sdram/sdram_controller: READ or WRITE a cycle too early after ACTIVATE (tRCD)
  localparam int SDRAM_PRECHARGE_SHORT = 176;  // sdram/sdram_controller: ACTIVATE or REFRESH a cycle too early after PRECHARGE (tRP)
  localparam int SDRAM_ACTIVE_SHORT = 177;  // sdram/sdram_controller: PRECHARGE a cycle too early after ACTIVATE (tRAS)
  localparam int SDRAM_CYCLE_SHORT = 178;  // sdram/sdram_controller: ACTIVATE too early after ACTIVATE (tRC)
  localparam int SDRAM_REFRESH_SHORT = 179;  // sdram/sdram_controller: a command a cycle too early after REFRESH (tRFC)
  localparam int SDRAM_RECOVERY_SHORT = 180;  // sdram/sdram_controller: PRECHARGE a cycle too early after a write (tWR)
  localparam int SDRAM_REFRESH_LATE = 181;  // sdram/sdram_controller: refreshes do not count that they may wait
  localparam int SDRAM_REFRESH_OPEN = 182;  // sdram/sdram_controller: REFRESH while a row is open
  localparam int SDRAM_TURN_SHORT = 183;  // sdram/sdram_controller: a write drives the pins next to the chip's data
  localparam int SDRAM_BURST_CUT = 184;  // sdram/sdram_controller: a command cuts a burst
  localparam int SDRAM_KEEPS_ROW = 185;  // sdram/sdram_controller: another row is taken for the open one
  localparam int SDRAM_HALVES_SWAPPED = 186;  // sdram/sdram_controller: the halves of a word are written in the other order
  localparam int SDRAM_READS_EARLY = 187;  // sdram/sdram_controller: data are taken a cycle early
  localparam int SDRAM_DRIVES_ONCE = 188;  // sdram/sdram_controller: the second half is not driven
  localparam int SDRAM_ONE_HALF_BURSTS = 189;  // sdram/sdram_controller: the mode says bursts of one
  localparam int SDRAM_CLOSES_ITSELF = 190;  // sdram/sdram_controller: READ and WRITE ask for a precharge of their own

  localparam int LINK_CRC_NOT_CHECKED = 201;  // link_receiver: every frame is whole
  localparam int LINK_LENGTH_NOT_CHECKED = 202;  // link_receiver: reads on after an impossible length
  localparam int LINK_GAP_IGNORED = 203;  // link_receiver: a frame that broke off swallows the next
  localparam int LINK_NO_ROLLBACK = 204;  // link_command_ring: words of a dropped frame stay
  localparam int LINK_COUNTS_BEFORE_CRC = 205;  // link_command_ring: words pass before their frame is whole
  localparam int LINK_SESSION_NOT_CHECKED = 206;  // emax_link: frames of any session count
  localparam int LINK_VERSION_NOT_CHECKED = 207;  // emax_link: frames of any version count
  localparam int LINK_SEQUENCE_NOT_CHECKED = 208;  // emax_link: data frames count in any order
  localparam int LINK_CREDIT_TOO_LARGE = 209;  // emax_link: promises 256 words that it has not
  localparam int LINK_SILENT_ABOUT_ROOM = 210;  // emax_link: says nothing when there is room again
  localparam int LINK_ANY_ACKNOWLEDGES = 211;  // link_answers: any frame of the host passes an answer
  localparam int LINK_DATA_NOT_REPEATED = 212;  // link_sender: the data frame under way is sent once
  localparam int LINK_HEADERS_LEAVE_ALONE = 213;  // link_answers: a pause closes a frame within an answer
endpackage
/* verilator lint_on UNUSEDPARAM */
/* verilator lint_on DECLFILENAME */
`endif
