#include "hls/lowering/identifiers.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <stdexcept>

namespace emax {
namespace {

// clang-format off
constexpr auto kKeywords = std::to_array<std::string_view>({
    "accept_on", "alias", "always", "always_comb", "always_ff", "always_latch", "and", "assert",
    "assign", "assume", "automatic", "before", "begin", "bind", "bins", "binsof", "bit", "break",
    "buf", "bufif0", "bufif1", "byte", "case", "casex", "casez", "cell", "chandle", "checker",
    "class", "clocking", "cmos", "config", "const", "constraint", "context", "continue", "cover",
    "covergroup", "coverpoint", "cross", "deassign", "default", "defparam", "design", "disable",
    "dist", "do", "edge", "else", "end", "endcase", "endchecker", "endclass", "endclocking",
    "endconfig", "endfunction", "endgenerate", "endgroup", "endinterface", "endmodule",
    "endpackage", "endprimitive", "endprogram", "endproperty", "endsequence", "endspecify",
    "endtable", "endtask", "enum", "event", "eventually", "expect", "export", "extends", "extern",
    "final", "first_match", "for", "force", "foreach", "forever", "fork", "forkjoin", "function",
    "generate", "genvar", "global", "highz0", "highz1", "if", "iff", "ifnone", "ignore_bins",
    "illegal_bins", "implements", "implies", "import", "incdir", "include", "initial", "inout",
    "input", "inside", "instance", "int", "integer", "interconnect", "interface", "intersect",
    "join", "join_any", "join_none", "large", "let", "liblist", "library", "local", "localparam",
    "logic", "longint", "macromodule", "matches", "medium", "modport", "module", "nand",
    "negedge", "nettype", "new", "nexttime", "nmos", "nor", "noshowcancelled", "not", "notif0",
    "notif1", "null", "or", "output", "package", "packed", "parameter", "pmos", "posedge",
    "primitive", "priority", "program", "property", "protected", "pull0", "pull1", "pulldown",
    "pullup", "pulsestyle_ondetect", "pulsestyle_onevent", "pure", "rand", "randc", "randcase",
    "randsequence", "rcmos", "real", "realtime", "ref", "reg", "reject_on", "release", "repeat",
    "restrict", "return", "rnmos", "rpmos", "rtran", "rtranif0", "rtranif1", "s_always",
    "s_eventually", "s_nexttime", "s_until", "s_until_with", "scalared", "sequence", "shortint",
    "shortreal", "showcancelled", "signed", "small", "soft", "solve", "specify", "specparam",
    "static", "string", "strong", "strong0", "strong1", "struct", "super", "supply0", "supply1",
    "sync_accept_on", "sync_reject_on", "table", "tagged", "task", "this", "throughout", "time",
    "timeprecision", "timeunit", "tran", "tranif0", "tranif1", "tri", "tri0", "tri1", "triand",
    "trior", "trireg", "type", "typedef", "union", "unique", "unique0", "unsigned", "until",
    "until_with", "untyped", "use", "uwire", "var", "vectored", "virtual", "void", "wait",
    "wait_order", "wand", "weak", "weak0", "weak1", "while", "wildcard", "wire", "with", "within",
    "wor", "xnor", "xor"});
static_assert(kKeywords.size() == 248, "as many as annex B of the standard lists");
static_assert(std::ranges::is_sorted(kKeywords));

constexpr auto kOtherWords = std::to_array<std::string_view>({
    "abort", "alignas", "alignof", "and_eq", "asm", "atomic_cancel", "atomic_commit",
    "atomic_noexcept", "auto", "bit_vector", "bitand", "bitor", "bool", "catch", "cdecl", "char",
    "char16_t", "char32_t", "compl", "complex", "concept", "const_cast", "const_iterator",
    "const_reference", "constexpr", "decltype", "delete", "deque", "double", "dynamic_cast",
    "explicit", "false", "far", "float", "friend", "goto", "huge", "interrupt", "list", "long",
    "map", "multimap", "multiset", "mutable", "namespace", "near", "noexcept", "not_eq",
    "nullptr", "operator", "override", "pascal", "private", "public", "queue", "register",
    "reinterpret_cast", "requires", "sc_clock", "sc_in", "sc_inout", "sc_out", "sc_signal",
    "sensitive", "sensitive_neg", "sensitive_pos", "set", "short", "sizeof", "stack",
    "static_assert", "static_cast", "switch", "synchronized", "template", "thread_local", "throw",
    "transaction_safe_dynamic", "true", "try", "type_info", "typeid", "typename", "using",
    "vector", "volatile", "wchar_t", "xor_eq"});
static_assert(std::ranges::is_sorted(kOtherWords));
// clang-format on

constexpr auto kUsedModules = std::to_array<std::string_view>(
    {"block_memory",   "delay_line",       "field_memory",      "fp_add",
     "fp_divide",      "fp_less",          "fp_multiply",       "fp_product",
     "fp_square",      "fp_square_root",   "mantissa_multiply", "mantissa_square",
     "fixed_add",      "fixed_fit",        "fixed_less",        "fixed_multiply",
     "fixed_negate",   "multiplier_18x18", "pipeline_stream",   "axis_fifo",
     "credit_counter", "ring_memory",      "valid_line",        "signed_multiply",
     "record_stream",  "record_ring"});

// The names that systemverilog.cpp and record_unit.cpp write into every module, whatever the graph.
constexpr auto kFixedNames = std::to_array<std::string_view>({"clk",
                                                              "probes",
                                                              "ADD_LATENCY",
                                                              "MULTIPLY_LATENCY",
                                                              "SQUARE_LATENCY",
                                                              "LESS_LATENCY",
                                                              "DIVIDE_LATENCY",
                                                              "SQUARE_ROOT_LATENCY",
                                                              "FIXED_ADD_LATENCY",
                                                              "FIXED_MULTIPLY_LATENCY",
                                                              "FIXED_NEGATE_LATENCY",
                                                              "FIXED_FIT_LATENCY",
                                                              "FIXED_LESS_LATENCY",
                                                              "SLOT_BITS",
                                                              "LATENCY",
                                                              "LAST_READ",
                                                              "write_enable",
                                                              "write_slot",
                                                              "write_record",
                                                              "slot",
                                                              "datapath",
                                                              "unused_parts",
                                                              "unused_probes"});

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

bool is_identifier(std::string_view text) {
  return !text.empty() && !is_digit(text.front()) && std::ranges::all_of(text, is_word);
}

std::span<const std::string_view> keywords() { return kKeywords; }

bool is_keyword(std::string_view word) { return std::ranges::binary_search(kKeywords, word); }

bool is_reserved_word(std::string_view word) {
  return is_keyword(word) || std::ranges::binary_search(kOtherWords, word);
}

std::span<const std::string_view> used_modules() { return kUsedModules; }

void check_module_name(const std::string& name) {
  const auto refuse = [&](const std::string& reason) {
    throw std::invalid_argument("'" + name + "' is " + reason +
                                "; a module's name is a letter or _, then letters, digits and _");
  };
  if (!is_identifier(name)) refuse("no SystemVerilog identifier");
  if (is_keyword(name)) refuse("a SystemVerilog keyword");
  if (std::ranges::find(kUsedModules, name) != kUsedModules.end()) {
    refuse("the name of a module of hls/rtl");
  }
}

Identifiers::Identifiers(const std::string& module)
    : taken_{module, module + "_unit", module + "_stream"} {
  taken_.insert(kFixedNames.begin(), kFixedNames.end());
  taken_.insert(kUsedModules.begin(), kUsedModules.end());
}

std::string Identifiers::take(std::string_view wanted) {
  std::string name(wanted);
  std::ranges::replace_if(
      name, [](char c) { return !is_word(c); }, '_');
  if (name.empty()) name = "value";
  if (is_digit(name.front())) name = "value_" + name;
  if (is_reserved_word(name)) name += "_value";
  for (int number = 1;; ++number) {
    std::string candidate = number == 1 ? name : name + '_' + std::to_string(number);
    if (taken_.insert(candidate).second) return candidate;
  }
}

}  // namespace emax
