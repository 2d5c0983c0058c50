#include "host/run_log/run_log.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace emax::test {
namespace {

const RunSettings kSettings = {{"emax", "1"}, {"cloud", "abc"}, {"seed", "7"}};

LoggedEvaluation measured(std::uint64_t index) {
  LoggedEvaluation e;
  e.index = index;
  e.genes = {0.1, -0.0, 5e-324, 1.7976931348623157e308, 3};
  e.seconds = 0.1;
  e.triangles = 100 + index;
  e.constraints = {-0.25, -1};
  e.squared_bits = 0x38f2c662;
  e.reconstruction_triangles = 4000000000;
  e.unmeshed_points = 3;
  return e;
}

LoggedEvaluation failed(std::uint64_t index) {
  LoggedEvaluation e;
  e.index = index;
  e.genes = {1, 2};
  e.failure = "timed out";
  e.message = "took \"longer\" than 3 s";
  return e;
}

TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1e7 + 1e-3, 0, 0}, {0, 0.1, 0}, {0, 0, 1}},
          {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
}

class RunLogTest : public testing::Test {
 protected:
  std::string refusal(const RunSettings& settings) {
    return message_of([&] { const RunLog log(path_, settings); });
  }

  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "mesh.ply.run";
};

TEST(RunLog, KeepsTheBudgetsThatGrow) {
  TemporaryFolder folder;
  using Budgets = std::vector<std::size_t>;
  {
    RunLog log(folder / "run", {{"of", "the test"}});
    EXPECT_EQ(log.give_budget(7), Budgets{7});
    EXPECT_EQ(log.give_budget(20), Budgets{20});  // nothing was evaluated under the other
    log.append(measured(0));
    EXPECT_EQ(log.give_budget(20), Budgets{20});
    EXPECT_EQ(log.give_budget(40), (Budgets{20, 40}));
  }
  RunLog log(folder / "run", {{"of", "the test"}});
  EXPECT_EQ(log.give_budget(30), (Budgets{20, 40}));
  EXPECT_EQ(log.give_budget(150), (Budgets{20, 40, 150}));
}

TEST(LoggedEvaluation, KeepsEveryBit) {
  for (const LoggedEvaluation& sent : {measured(3), failed(~std::uint64_t{0})}) {
    const LoggedEvaluation got = decode_evaluation(encode(sent));
    EXPECT_EQ(got, sent);
    for (std::size_t i = 0; i < sent.genes.size(); ++i) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(got.genes[i]),
                std::bit_cast<std::uint64_t>(sent.genes[i]));
    }
  }
  LoggedEvaluation e = measured(1);
  e.stopped = true;
  e.expected_triangles = 1234;
  EXPECT_EQ(decode_evaluation(encode(e)), e);
  e.mesh_crc = 0xffffffff;
  for (const double violation : {-0.0, 5e-324, 1e300, std::numeric_limits<double>::infinity()}) {
    e.constraints = {violation};
    EXPECT_EQ(std::bit_cast<std::uint64_t>(decode_evaluation(encode(e)).violation()),
              std::bit_cast<std::uint64_t>(violation));
  }
  const std::vector<std::uint8_t> bytes = encode(e);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THROW(decode_evaluation(std::span(bytes).first(length)), Error) << length;
  }
}

TEST_F(RunLogTest, ContinuesWhereItWasLeft) {
  {
    RunLog log(path_, kSettings);
    EXPECT_EQ(log.size(), 0u);
    log.append(measured(0));
    log.append(failed(4));
    log.append(measured(2));
    EXPECT_EQ(*log.find(4), failed(4));
  }
  std::filesystem::resize_file(path_ / "evaluations.log",
                               std::filesystem::file_size(path_ / "evaluations.log") - 3);
  {
    RunLog log(path_, kSettings);
    EXPECT_EQ(log.size(), 2u);
    EXPECT_GT(log.loss().torn, 3u);
    EXPECT_EQ(*log.find(0), measured(0));
    EXPECT_EQ(*log.find(4), failed(4));
    EXPECT_EQ(log.find(2), nullptr);
    log.append(measured(2));
  }
  const RunLog log(path_, kSettings);
  EXPECT_EQ(log.size(), 3u);
  EXPECT_EQ(log.loss().torn, 0u);
}

TEST_F(RunLogTest, NamesTheFirstSettingThatDiffers) {
  { RunLog(path_, kSettings).append(measured(0)); }
  const std::string before = bytes_of(path_ / "evaluations.log");
  RunSettings other = kSettings;
  other[1].second = "abd";
  other[2].second = "8";
  expect_clear(refusal(other), path_.string(), "cloud abc, this one has abd", "--resume");
  other[1].second = "abc";
  expect_clear(refusal(other), path_.string(), "seed 7, this one has 8", "--resume");
  RunSettings more = kSettings, fewer = kSettings;
  more.emplace_back("method", "gp3");
  expect_clear(refusal(more), path_.string(), "method (none), this one has gp3", "--resume");
  fewer.pop_back();
  expect_clear(refusal(fewer), path_.string(), "seed 7, this one has (none)", "--resume");
  EXPECT_EQ(bytes_of(path_ / "evaluations.log"), before);
  EXPECT_EQ(RunLog(path_, kSettings).size(), 1u);
  for (const char* unreadable : {"{", "[]", "7", "{\"seed\": 7}", "{\"seed\": null}"}) {
    folder_.write("mesh.ply.run/settings.json", unreadable);
    expect_clear(refusal(kSettings), (path_ / "settings.json").string(), "read", "another folder");
  }
}

// Of another version, which the settings name.
TEST_F(RunLogTest, ComparesSettingsBeforeItReadsRecords) {
  { RunLog(path_, kSettings).append(measured(0)); }
  {
    RecordFile file(path_ / "evaluations.log");
    file.read([](auto) {});
    file.append(std::vector<std::uint8_t>{0xa0});  // an empty map
  }
  RunSettings later = kSettings;
  later[0].second = "2";
  expect_clear(refusal(later), path_.string(), "emax 1", "name another folder");
  expect_clear(refusal(kSettings), (path_ / "evaluations.log").string(), "not an evaluation",
               "name another folder");
}

TEST_F(RunLogTest, SettlesWhatIsFoundOutLater) {
  RunSettings open = kSettings;
  open.emplace_back("reference", "");
  {
    RunLog log(path_, open);
    log.settle("reference", "r1");
    log.settle("reference", "r2");  // nothing depends on it yet
    log.append(measured(0));
    log.settle("reference", "r2");
  }
  RunLog log(path_, open);
  log.settle("reference", "r2");
  expect_clear(message_of([&] { log.settle("reference", "r3"); }), path_.string(),
               "reference r2, this one has r3", "--resume");
}

TEST_F(RunLogTest, IsHeldByOne) {
  const RunLog first(path_, kSettings);
  expect_clear(refusal(kSettings), path_.string(), "another process", "--resume");
}

TEST_F(RunLogTest, LeavesNoFolderWithoutEvaluations) {
  { const RunLog log(path_, kSettings); }
  EXPECT_EQ(folder_.entries(), 0);
  // One that was there before stays, and another run may use it.
  std::filesystem::create_directory(path_);
  { const RunLog log(path_, kSettings); }
  const RunLog other(path_, {{"seed", "8"}});
  EXPECT_EQ(other.size(), 0u);
}

TEST_F(RunLogTest, RefusesWhatIsNoRunsFolder) {
  std::filesystem::create_directory(path_);
  folder_.write("mesh.ply.run/thesis.tex", "years of work");
  expect_clear(refusal(kSettings), path_.string(), "other files", "another folder");
  EXPECT_EQ(bytes_of(path_ / "thesis.tex"), "years of work");
  std::filesystem::remove_all(path_);
  folder_.write("mesh.ply.run", "a file");
  expect_clear(refusal(kSettings), path_.string(), "cannot be created", "name a folder");
  EXPECT_THROW(RunLog(folder_ / "no/such", kSettings), Error);
}

TEST_F(RunLogTest, KeepsMeshesUntilTheyAreDropped) {
  {
    RunLog log(path_, kSettings);
    log.append(measured(5), tetrahedron());
    log.append(measured(6), tetrahedron());
    log.append(measured(7));
    log.drop_mesh(6);
    log.drop_mesh(7);
  }
  folder_.write("mesh.ply.run/mesh-9.ply", "its evaluation was not logged any more");
  RunLog log(path_, kSettings);
  EXPECT_FALSE(std::filesystem::exists(path_ / "mesh-9.ply"));
  const std::optional<TriangleMesh> mesh = log.mesh(*log.find(5));
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->vertices, tetrahedron().vertices);
  EXPECT_EQ(mesh->triangles, tetrahedron().triangles);
  EXPECT_FALSE(log.mesh(*log.find(6)));
  EXPECT_FALSE(log.mesh(*log.find(7)));

  std::string bytes = bytes_of(path_ / "mesh-5.ply");
  bytes[bytes.size() - 30] = static_cast<char>(bytes[bytes.size() - 30] ^ 1);
  folder_.write("mesh.ply.run/mesh-5.ply", bytes);
  EXPECT_FALSE(log.mesh(*log.find(5)));
}

TEST_F(RunLogTest, RemovesWhatIsItsOwn) {
  {
    RunLog log(path_, kSettings);
    log.append(measured(5), tetrahedron());
    log.remove();
  }
  EXPECT_EQ(folder_.entries(), 0);
  RunLog log(path_, kSettings);
  log.append(measured(5), tetrahedron());
  folder_.write("mesh.ply.run/notes.txt", "a person's");
  log.remove();
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(path_), {}), 1);
}

}  // namespace
}  // namespace emax::test
