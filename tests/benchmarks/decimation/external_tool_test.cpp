#include "tests/benchmarks/decimation/external_tool.h"

#include <gtest/gtest.h>

#include "sw_model/base/error.h"
#include "tests/benchmarks/decimation/raw_mesh.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

using benchmarks::OptionSet;
using benchmarks::Tool;

constexpr const char* kGreeting =
    R"({"name": "toy", "version": "7", "sets": [{"name": "all", "parameter": "triangles"},)"
    R"( {"name": "near", "parameter": "tolerance"}]})";

// Two triangles, off the origin and 4 wide.
TriangleMesh square() {
  return {{{9, 1, 0}, {13, 1, 0}, {13, 3, 0}, {9, 3, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

// A decimator whose process does `call` for each request, with the folder in $1.
class Toy {
 public:
  explicit Toy(const std::string& call, const std::string& greeting = kGreeting) {
    script_ = folder_.write(
        "toy.sh", "echo '" + greeting + "'\nwhile read -r request; do\n" + call + "\ndone\n");
  }

  Tool tool() const { return benchmarks::external_tool("sh " + script_.string()); }
  TemporaryFolder& folder() { return folder_; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path script_;
};

constexpr const char* kCopies = "cp $1/start/* $1/result; echo '{\"seconds\": 2.5}'";

// What a call of the first set throws.
std::string reason(const Tool& tool) {
  const OptionSet set = tool.option_sets(square(), 0.5).front();
  try {
    set.simplify(1);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

std::string reason_of_start(const std::string& command) {
  try {
    benchmarks::external_tool(command);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(ExternalTool, AnswersWithItsMeshInTheUnitOfTheStart) {
  const Tool tool = Toy(kCopies).tool();
  EXPECT_EQ(tool.name, "toy");
  EXPECT_EQ(tool.version, "7");
  const auto sets = tool.option_sets(square(), 0.5);
  ASSERT_EQ(sets.size(), 2);
  EXPECT_EQ(sets[0].name, "all");
  EXPECT_EQ(sets[0].parameter, OptionSet::Parameter::kTriangles);
  EXPECT_EQ(sets[1].parameter, OptionSet::Parameter::kTolerance);
  for (int call = 0; call < 3; ++call) {
    const TriangleMesh mesh = sets[0].simplify(2);
    EXPECT_EQ(mesh.triangles, square().triangles);
    EXPECT_EQ(mesh.vertices, square().vertices);
    EXPECT_EQ(sets[0].seconds(), 2.5);
  }
}

TEST(ExternalTool, GetsANumberOfTrianglesOrAToleranceOfAWidthOfOne) {
  Toy toy("echo \"$request\" >> $0.requests; " + std::string(kCopies));
  const auto sets = toy.tool().option_sets(square(), 0.5);
  sets[0].simplify(20);
  sets[1].simplify(2);
  EXPECT_EQ(bytes_of(toy.folder() / "toy.sh.requests"),
            "{\"parameter\":20.0,\"set\":0}\n{\"parameter\":0.25,\"set\":1}\n");
}

TEST(ExternalTool, GivesTheReasonOfTheTool) {
  EXPECT_EQ(reason(Toy("echo '{\"failure\": \"not closed\"}'").tool()), "not closed");
  EXPECT_EQ(reason_of_start("sh -c 'echo \"{\\\"failure\\\": \\\"not installed\\\"}\"'"),
            "not installed");
}

TEST(ExternalTool, SaysHowAProcessEndedAndStartsItAnew) {
  EXPECT_EQ(reason_of_start("sh -c 'echo oh no >&2; exit 3'"), "its process ended with 3: oh no");
  Toy toy("if mkdir $0.once 2>/dev/null; then kill -9 $$; fi; " + std::string(kCopies));
  const auto set = toy.tool().option_sets(square(), 0.5).front();
  try {
    set.simplify(1);
    ADD_FAILURE() << "the end of the process was not noticed";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "its process ended by signal 9");
  }
  EXPECT_EQ(set.simplify(1).triangles.size(), 2);
}

// A broken mesh is a failure with a reason, never a result.
TEST(ExternalToolFault, ABrokenMeshIsNoResult) {
  const std::string done = "; echo '{\"seconds\": 0}'";
  const std::string copies = "cp $1/start/* $1/result; ";
  EXPECT_EQ(reason(Toy("true" + done).tool()), "there is no file vertices.f64");
  EXPECT_EQ(reason(Toy(copies + "printf x >> $1/result/triangles.u32" + done).tool()),
            "triangles.u32 ends within a row");
  EXPECT_EQ(reason(Toy(copies + "printf 123456789012 >> $1/result/triangles.u32" + done).tool()),
            "a triangle of the mesh has a vertex that is not there");
  EXPECT_EQ(
      reason(
          Toy(copies + R"(printf '\377%.0s' $(seq 24) >> $1/result/vertices.f64)" + done).tool()),
      "a coordinate of the mesh is not finite");
}

TEST(ExternalToolFault, AMeshOfAnEarlierCallIsNoResult) {
  Toy toy(
      "if mkdir $0.once 2>/dev/null; then cp $1/start/* $1/result; fi; "
      "echo '{\"seconds\": 0}'");
  const auto set = toy.tool().option_sets(square(), 0.5).front();
  EXPECT_EQ(set.simplify(1).triangles.size(), 2);
  EXPECT_THROW(set.simplify(1), Error);
}

TEST(ExternalToolFault, AnAnswerOfAnotherFormIsNoResult) {
  EXPECT_EQ(reason(Toy("echo yes").tool()), "it answers 'yes'");
  EXPECT_EQ(reason(Toy("echo '{}'").tool()), "it does not answer how long the call took");
}

}  // namespace
}  // namespace emax::test
