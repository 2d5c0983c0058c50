// sum = a + b (a - b with SUBTRACT), LATENCY clock edges later, a pair every cycle. The rules of
// docs/numerics.md: nearest even, subnormals count as signed zero in and out, NaN is 0x7fc00000,
// x - x = +0. A tiny sum of normal numbers is exact, so flushing does not depend on rounding.
//
// One path: order by magnitude, align, add, count leading zeros by nibbles, normalise, round.
// Thirteen steps, each at most one carry chain or three levels of logic, with a cut for a register
// after each; a LATENCY below 13 leaves out cuts in the order of DROPPED, 14 adds a register at the
// input, which eases routing.
`include "mutation.svh"
`include "registered.svh"

module fp_add #(
    parameter int EXPONENT = 8,
    parameter int MANTISSA = 23,
    parameter int LATENCY = 13,
    parameter bit SUBTRACT = 0
) (
    input  logic                       clk,
    input  logic [EXPONENT+MANTISSA:0] a,
    input  logic [EXPONENT+MANTISSA:0] b,
    output logic [EXPONENT+MANTISSA:0] sum
);
  localparam int STEPS = 13;
  localparam int W = 1 + EXPONENT + MANTISSA;
  localparam int ALIGNED = MANTISSA + 3;  // hidden bit, fraction, guard and round bit
  localparam int SHIFT_BITS = $clog2(ALIGNED + 1);
  localparam int LAST = 31 - MANTISSA;  // place of the fraction's last bit when normalised to 32 bits

  if (LATENCY < 1 || LATENCY > STEPS + 1) begin : bad_latency
    $error("fp_add: LATENCY must be 1 to 14");
  end
  if (MANTISSA < 2 || MANTISSA > 27 || EXPONENT < SHIFT_BITS || EXPONENT > 11) begin : bad_format
    $error("fp_add: MANTISSA must be 2 to 27, EXPONENT clog2(MANTISSA + 4) to 11");
  end

  // The steps whose cuts go first when registers are few, least harmful first, four bits each.
  localparam logic [4*STEPS-1:0] DROPPED = 52'hc_8164_92b7_3a50;
  /* verilator coverage_off */  // evaluated before simulation
  function automatic logic [STEPS-1:0] chosen_cuts();
    chosen_cuts = '1;
    for (int i = 0; i < STEPS - LATENCY; i++) chosen_cuts[DROPPED[4*i+:4]] = 1'b0;
  endfunction
  /* verilator coverage_on */
  localparam logic [STEPS-1:0] CUT = chosen_cuts();

  // Step 0: nothing but a register.
  localparam int ENTRY = (LATENCY > STEPS ? LATENCY - STEPS : 0) + 32'(CUT[0]);
  logic [W-1:0] a_0, b_0;
  delay_line #(.WIDTH(W), .DEPTH(ENTRY)) cut_0a (.clk, .d(a), .q(a_0));
  delay_line #(.WIDTH(W), .DEPTH(ENTRY)) cut_0b (
      .clk, .d({b[W-1] ^ SUBTRACT, b[W-2:0]}), .q(b_0)
  );

  // Step 1: which magnitude is less (a difference's top bit leaves a carry chain faster than a
  // comparison does); both differences of the exponents; which operands are zero.
  logic [W-1:0] a_1, b_1;
  logic [EXPONENT-1:0] a_minus_b_1, b_minus_a_1;
  logic less_1, a_zero_1, b_zero_1;
  /* verilator lint_off UNUSEDSIGNAL */  // only the sign matters
  logic [W-1:0] order_0;
  /* verilator lint_on UNUSEDSIGNAL */
  assign order_0 = {1'b0, a_0[W-2:0]} - {1'b0, b_0[W-2:0]};
  `REGISTERED(CUT[1], a_1, a_0)
  `REGISTERED(CUT[1], b_1, b_0)
  `REGISTERED(CUT[1], {a_minus_b_1, b_minus_a_1, less_1, a_zero_1, b_zero_1}, {
      a_0[W-2-:EXPONENT] - b_0[W-2-:EXPONENT],
      b_0[W-2-:EXPONENT] - a_0[W-2-:EXPONENT],
      `MUTATED(ADD_ORDER_BY_EXPONENT, order_0[W-1],
               a_0[W-2-:EXPONENT] < b_0[W-2-:EXPONENT]),
      a_0[W-2-:EXPONENT] == '0,
      b_0[W-2-:EXPONENT] == '0
    })

  // Step 2: the larger and the smaller operand and how far to shift the latter. What goes along:
  // the larger's sign, whether both are negative (the sign of a zero sum), whether to subtract.
  logic [W-2:0] larger_2;
  logic [MANTISSA-1:0] smaller_2;
  logic [EXPONENT-1:0] shift_2;
  logic small_zero_2, sign_2, negative_2, subtract_2;
  `REGISTERED(CUT[2], larger_2, less_1 ? b_1[W-2:0] : a_1[W-2:0])
  `REGISTERED(CUT[2], smaller_2, less_1 ? a_1[MANTISSA-1:0] : b_1[MANTISSA-1:0])
  `REGISTERED(CUT[2], {shift_2, small_zero_2, sign_2, negative_2, subtract_2}, {
      less_1 ? b_minus_a_1 : a_minus_b_1,
      less_1 ? a_zero_1 : b_zero_1,
      less_1 ? b_1[W-1] : a_1[W-1],
      a_1[W-1] & b_1[W-1],
      a_1[W-1] ^ b_1[W-1]
    })

  // Step 3: shift the smaller by eights; find out what is special (the fraction is looked at in
  // halves: fewer levels of logic). An infinite smaller operand shows as a shift of zero beside a
  // larger one that is not finite.
  localparam int KINDS = 4;  // zero, special (infinity or NaN), NaN, negative
  localparam int HALF = MANTISSA / 2;
  function automatic logic lost_bytes(input logic [31:0] value,
                                      input logic [SHIFT_BITS-1:0] shift);
    lost_bytes = 1'b0;
    for (int i = 0; i < 24; i += 8) begin
      lost_bytes |= (32'(shift) >= i + 8) & (|value[i+:8]);
    end
  endfunction
  logic [ALIGNED-1:0] smaller_0b, smaller_3;
  logic [MANTISSA-1:0] larger_3;
  logic [EXPONENT-1:0] exponent_3;
  logic [2:0] shift_3;
  logic far_3, small_zero_3, lost_3, sign_3, subtract_3;
  logic zero_3, special_3, upper_3, lower_3, opposite_3, negative_3;
  assign smaller_0b = {1'b1, smaller_2, 2'b00};
  `REGISTERED(CUT[3], smaller_3, smaller_0b >> (shift_2[SHIFT_BITS-1:0] & ~(SHIFT_BITS'(7))))
  `REGISTERED(CUT[3], {exponent_3, larger_3}, larger_2)
  `REGISTERED(CUT[3], {
        shift_3, far_3, small_zero_3, lost_3, sign_3, subtract_3,
        zero_3, special_3, upper_3, lower_3, opposite_3, negative_3
      }, {
      3'(shift_2),
      (shift_2 >> SHIFT_BITS) != '0,
      small_zero_2,
      lost_bytes(32'(smaller_0b), shift_2[SHIFT_BITS-1:0]),
      sign_2,
      subtract_2,
      larger_2[W-2-:EXPONENT] == '0,
      larger_2[W-2-:EXPONENT] == '1,
      larger_2[MANTISSA-1:HALF] != '0,
      larger_2[HALF-1:0] != '0,
      subtract_2 & shift_2 == '0,
      negative_2
    })

  // Step 4: shift by twos; nothing is left of a zero, and only a sticky bit of what is far below.
  logic [ALIGNED-1:0] smaller_4;
  logic [MANTISSA-1:0] larger_4;
  logic [EXPONENT-1:0] exponent_4;
  logic shift_4, lost_4, sign_4, subtract_4, lost_now_3;
  logic [KINDS-1:0] kind_4;
  logic [5:0] low_3;
  assign low_3 = 6'(smaller_3);
  assign lost_now_3 = lost_3 | far_3 | ((shift_3[2] | shift_3[1]) & (|low_3[1:0]))
      | (shift_3[2] & (|low_3[3:2])) | (shift_3[2] & shift_3[1] & (|low_3[5:4]));
  `REGISTERED(CUT[4], smaller_4, far_3 | `MUTATED(ADD_SUBNORMAL_OPERAND, small_zero_3, 1'b0)
       ? '0 : smaller_3 >> {shift_3[2:1], 1'b0})
  `REGISTERED(CUT[4], {exponent_4, larger_4}, {exponent_3, larger_3})
  `REGISTERED(CUT[4], {shift_4, lost_4, sign_4, subtract_4, kind_4}, {
      shift_3[0],
      ~small_zero_3 & lost_now_3,
      sign_3,
      subtract_3,
      zero_3,
      special_3,
      special_3 & (upper_3 | lower_3 | opposite_3),
      negative_3
    })

  // Step 5: shift by one and complement for a subtraction, together one level of logic.
  logic [ALIGNED-1:0] smaller_5;
  logic [MANTISSA-1:0] larger_5;
  logic [EXPONENT-1:0] exponent_5;
  logic lost_5, sign_5, subtract_5;
  logic [KINDS-1:0] kind_5;
  `REGISTERED(CUT[5], smaller_5,
              (shift_4 ? {1'b0, smaller_4[ALIGNED-1:1]} : smaller_4) ^ {ALIGNED{subtract_4}})
  `REGISTERED(CUT[5], {exponent_5, larger_5}, {exponent_4, larger_4})
  `REGISTERED(CUT[5], {lost_5, sign_5, subtract_5, kind_5},
              {lost_4 | (shift_4 & smaller_4[0]), sign_4, subtract_4, kind_4})

  // Step 6: add. What was lost borrows one from a difference, and it stays as the sticky bit.
  /* verilator lint_off UNUSEDSIGNAL */  // bit 0 makes the carry in
  logic [ALIGNED+1:0] chain_5;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [ALIGNED:0] total_6;
  logic [EXPONENT-1:0] exponent_6;
  logic lost_6, sign_6;
  logic [KINDS-1:0] kind_6;
  assign chain_5 = {2'b01, larger_5, 3'b001}
      + {subtract_5, smaller_5, subtract_5 & ~`MUTATED(ADD_NO_BORROW, lost_5, 1'b0)};
  `REGISTERED(CUT[6], total_6, chain_5[ALIGNED+1:1])
  `REGISTERED(CUT[6], {exponent_6, lost_6, sign_6, kind_6},
              {exponent_5, `MUTATED(ADD_LOST_STICKY, lost_5, 1'b0), sign_5, kind_5})

  // Step 7: the sticky bit joins below the total (it is set only where at most one leading bit is
  // zero) and leading zero nibbles are counted.
  // The count's last bit is one of four flags, chosen by its other bits a step later.
  logic [31:0] total_6w, total_7;
  logic [EXPONENT-1:0] exponent_7;
  logic [1:0] zeros_7;
  logic [3:0] odd_7;
  logic sign_7;
  logic [KINDS-1:0] kind_7;
  assign total_6w = 32'({total_6, lost_6}) << (30 - ALIGNED);
  `REGISTERED(CUT[7], total_7, total_6w)
  `REGISTERED(CUT[7], {exponent_7, zeros_7, odd_7, sign_7, kind_7}, {
      exponent_6,
      ~(|total_6w[31:16]),
      (|total_6w[31:16]) ? ~(|total_6w[31:24]) : ~(|total_6w[15:8]),
      ~{|total_6w[7:4], |total_6w[15:12], |total_6w[23:20], |total_6w[31:28]},
      sign_6,
      kind_6
    })

  // Step 8: normalise by sixteen and eight.
  logic [31:0] total_8;
  logic [EXPONENT-1:0] exponent_8;
  logic [2:0] zeros_8;
  logic sign_8;
  logic [KINDS-1:0] kind_8;
  `REGISTERED(CUT[8], total_8, total_7 << {zeros_7, 3'b000})
  `REGISTERED(CUT[8], {exponent_8, zeros_8, sign_8, kind_8},
              {exponent_7, zeros_7, odd_7[zeros_7], sign_7, kind_7})

  // Step 9: normalise by four and count what is left; the exponent, now one bit wider and signed,
  // follows. It stays one below that of the sum until the hidden bit is added to it.
  logic [31:0] total_8n, total_9;
  logic [EXPONENT:0] exponent_9;
  logic [1:0] zeros_9;
  logic sign_9;
  logic [KINDS-1:0] kind_9;
  assign total_8n = zeros_8[0] ? {total_8[27:0], 4'b0000} : total_8;
  `REGISTERED(CUT[9], total_9, total_8n)
  `REGISTERED(CUT[9], {exponent_9, zeros_9, sign_9, kind_9}, {
      {1'b0, exponent_8} - (EXPONENT + 1)'({zeros_8, 2'b00}),
      ~(|total_8n[31:30]),
      (|total_8n[31:30]) ? ~total_8n[31] : ~total_8n[29],
      sign_8,
      kind_8
    })

  // Step 10: normalise by two and one.
  logic [31:0] total_10;
  logic [EXPONENT:0] exponent_10;
  logic sign_10;
  logic [KINDS-1:0] kind_10;
  `REGISTERED(CUT[10], total_10, total_9 << zeros_9)
  `REGISTERED(CUT[10], {exponent_10, sign_10, kind_10},
              {exponent_9 - (EXPONENT + 1)'(zeros_9), sign_9, kind_9})

  // Step 11: round; the carry runs through the exponent, where the hidden bit adds one. Whether to
  // round up is decided inside the chain: adding the half bit to each reason in turn carries when
  // the half bit and a reason before or here are set. An exponent that becomes all ones is infinity,
  // whose fraction is already zero if rounding led there.
  localparam int REASONS = 4;  // the fraction's last bit and the three places below the half bit
  /* verilator lint_off UNUSEDSIGNAL */  // the low places make the carry in
  logic [W-2+REASONS:0] rounded_10;
  /* verilator lint_on UNUSEDSIGNAL */
  logic [W-2:0] rounded_11;
  logic zero_10, special_10, nan_10, negative_10, none_10, sign_11;
  logic ones_exponent_11, clear_exponent_11, clear_fraction_11, nan_11;
  assign {zero_10, special_10, nan_10, negative_10} = kind_10;
  assign none_10 = zero_10 | ~total_10[31];
  assign rounded_10 = {exponent_10[EXPONENT-1:0], total_10[30:LAST], {REASONS{total_10[LAST-1]}}}
      + {EXPONENT'(1), MANTISSA'(0), total_10[LAST-2-:REASONS-1],
         `MUTATED(ADD_TIES_UP, total_10[LAST], 1'b1)};
  `REGISTERED(CUT[11], rounded_11, rounded_10[W-2+REASONS:REASONS])
  `REGISTERED(CUT[11], {sign_11, ones_exponent_11, clear_exponent_11, clear_fraction_11, nan_11}, {
      ~nan_10 & (none_10 ? `MUTATED(ADD_ZERO_SIGN, negative_10, sign_10) : sign_10),
      special_10,
      ~special_10 & (none_10 | `MUTATED(ADD_NO_FLUSH, exponent_10[EXPONENT], 1'b0)),
      special_10 | none_10 | exponent_10[EXPONENT]
          | `MUTATED(ADD_OVERFLOW_FRACTION, exponent_10 == (EXPONENT + 1)'((1 << EXPONENT) - 2), 1'b0),
      nan_10
    })

  // Step 12: the result.
  `REGISTERED(CUT[12], sum, {
      sign_11,
      ones_exponent_11 ? '1 : clear_exponent_11 ? '0 : rounded_11[W-2-:EXPONENT],
      clear_fraction_11 ? {nan_11, (MANTISSA - 1)'(0)} : rounded_11[MANTISSA-1:0]
    })
endmodule
