// The configuration of a run.
#include "host/config/config.h"

#include "host/parameters/chain_parameters.h"
#include "tests/fuzz/files.h"

namespace emax::fuzz {
namespace {

const Parameters& parameters() {
  static const Parameters all = chain_parameters(kAutoMethod, kAutoDecimator);
  return all;
}

}  // namespace

void read(Input input) {
  const Config config = read_config(write("file.toml", input), parameters());
  require(config.genes.size() == parameters().size(), "each parameter has its gene");
  for (const Parameter& gene : config.genes) {
    require(gene.lower <= gene.standard && gene.standard <= gene.upper,
            "a standard value lies in its domain");
  }
  require(!named_values(config).empty(), "a configuration has values");
  require(!make_problem(config, "").starts.empty(), "a search has a start");
}

std::vector<std::string> seeds() {
  return {
      default_config_text(parameters()),
      "[search]\nbudget = 7\n[search.operators]\n[genes.\"normals.k\"]\nlower = 10\nupper = 20\n"
      "standard = 15\n[[linear]]\nterms = { \"normals.k\" = 1, \"gp3.mu\" = -2.0 }\n"
      "at_most = 1e3\n"};
}

}  // namespace emax::fuzz
