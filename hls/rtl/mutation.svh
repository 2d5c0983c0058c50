// `MUTATED(ID, RIGHT, WRONG): RIGHT; in a mutation build WRONG when the mutant ID is active. The
// mutants stand in mutation.sv.
`ifndef EMAX_MUTATION_SVH
`define EMAX_MUTATION_SVH
`ifdef EMAX_MUTATION
`define MUTATED(ID, RIGHT, WRONG) ((emax_mutation::active == emax_mutation::ID) ? (WRONG) : (RIGHT))
`else
`define MUTATED(ID, RIGHT, WRONG) (RIGHT)
`endif
`endif
