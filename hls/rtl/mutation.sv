// The mutants of the mutation build, one a line: its number, its name, its fault. The active one is
// chosen at run time with +mutant=NUMBER; 0 is the unchanged design.
`ifdef EMAX_MUTATION
package emax_mutation;
  int active /*verilator public_flat_rw*/ = 0;

  localparam int ADD_LOST_STICKY = 1;  // fp_add: bits shifted out in alignment do not reach rounding
endpackage
`endif
