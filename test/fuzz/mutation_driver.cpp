// Runs a fuzz target where libFuzzer is missing: on each file of the corpus, then on mutations of them, which are a
// function of the seed. It takes libFuzzer's arguments:
//
//   fuzz_task -runs=2000 -seed=1 CORPUS_FOLDER_OR_FILE...
//
// The input at hand lies in the file crash-<target>. It stays there if the program does not end by itself.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "early_fusion/core/random.h"
#include "fuzz_target.h"

namespace {

namespace fs = std::filesystem;
using early_fusion::core::Random;

constexpr unsigned kMaxSec = 60;  // of one run: more is a finding
constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
constexpr int kMaxMutations = 4;

struct Arguments {
  int runs = 0;
  std::uint64_t seed = 1;
  std::vector<std::string> corpus;
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  for (const std::string& word : std::vector<std::string>(argv + 1, argv + argc)) {
    if (word.compare(0, 6, "-runs=") == 0) {
      arguments.runs = std::stoi(word.substr(6));
    } else if (word.compare(0, 6, "-seed=") == 0) {
      arguments.seed = std::stoull(word.substr(6));
    } else {
      arguments.corpus.push_back(word);
    }
  }
  return arguments;
}

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The files' contents, ordered by the files' names.
std::vector<std::string> readCorpus(const std::vector<std::string>& places) {
  std::vector<fs::path> files;
  for (const std::string& place : places) {
    if (!fs::is_directory(place)) files.emplace_back(place);
    if (!fs::is_directory(place)) continue;
    for (const auto& entry : fs::directory_iterator(place)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> corpus;
  for (const fs::path& file : files) corpus.push_back(read(file));
  return corpus;
}

/// A place in a text, or behind its end. Most are near the begin: binary files have their headers there.
std::size_t placeIn(const std::string& text, Random& random) {
  const std::size_t size = random.below(2) == 0 ? std::min<std::size_t>(text.size(), 256) : text.size();
  return random.below(static_cast<int>(size) + 1);
}

std::size_t lengthFrom(std::size_t at, const std::string& text, Random& random) {
  const std::size_t most = std::min<std::size_t>(text.size() - at, 1 << random.below(10));
  return random.below(static_cast<int>(most) + 1);
}

/// A number or word that programs often do not expect.
std::string interestingText(Random& random) {
  static const std::array<const char*, 16> texts = {"nan", "inf",    "-inf",       "1e999", "-1",
                                                    "0",   "1e-320", "2147483648", "",      "~",
                                                    "{",   "[[[[",   "\"",         "<a>",   "18446744073709551616",
                                                    "../"};
  return texts[random.below(texts.size())];
}

/// Bytes that are a small, a large or a negative number of 1, 2, 4 or 8 bytes.
std::string interestingBytes(Random& random) {
  static const std::array<std::uint64_t, 8> numbers = {
      0, 1, 0x7fffffff, 0x80000000, ~std::uint64_t{0}, 0x7ff0000000000000, 0x7fffffffffffffff, 0x10000};
  const std::uint64_t number = numbers[random.below(numbers.size())];
  return {reinterpret_cast<const char*>(&number), std::size_t{1} << random.below(4)};
}

/// Replaces the number at or after `at`, if there is one.
void replaceNumber(std::string& text, std::size_t at, const std::string& by) {
  const std::size_t begin = text.find_first_of("0123456789", at);
  if (begin == std::string::npos) return;
  const std::size_t end = std::min(text.find_first_not_of("0123456789.eE+-", begin), text.size());
  text.replace(begin, end - begin, by);
}

void mutateOnce(std::string& input, const std::vector<std::string>& corpus, Random& random) {
  const std::size_t at = placeIn(input, random);
  const std::size_t length = lengthFrom(at, input, random);
  switch (random.below(8)) {
    case 0:
      if (at < input.size()) input[at] ^= static_cast<char>(1 << random.below(8));
      return;
    case 1:
      if (at < input.size()) input[at] = static_cast<char>(random.below(256));
      return;
    case 2:
      input.erase(at, length);
      return;
    case 3:
      input.insert(at, input.substr(at, length));
      return;
    case 4:
      input.replace(at, std::min<std::size_t>(length, 8), interestingBytes(random));
      return;
    case 5:
      replaceNumber(input, at, interestingText(random));
      return;
    case 6:
      input.insert(at, interestingText(random));
      return;
    default: {
      const std::string& other = corpus[random.below(static_cast<int>(corpus.size()))];
      const std::size_t from = placeIn(other, random);
      input.replace(at, length, other, from, lengthFrom(from, other, random));
    }
  }
}

std::string mutated(const std::vector<std::string>& corpus, std::uint64_t seed, int run) {
  Random random(seed, {static_cast<std::uint64_t>(run)});
  std::string input = corpus[random.below(static_cast<int>(corpus.size()))];
  for (int count = 1 + random.below(kMaxMutations); count > 0; --count) mutateOnce(input, corpus, random);
  input.resize(std::min(input.size(), kMaxBytes));
  return input;
}

/// The input at hand, in a file that outlives the process however it ends.
class CrashFile {
 public:
  explicit CrashFile(std::string path) : path_(std::move(path)) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file_ < 0) early_fusion::fuzz::fail(path_ + ": cannot write");
  }
  ~CrashFile() {
    ::close(file_);
    ::unlink(path_.c_str());
  }
  CrashFile(const CrashFile&) = delete;
  CrashFile& operator=(const CrashFile&) = delete;

  void set(const std::string& input) const {
    const bool written = ::pwrite(file_, input.data(), input.size(), 0) == static_cast<ssize_t>(input.size()) &&
                         ::ftruncate(file_, static_cast<off_t>(input.size())) == 0;
    if (!written) early_fusion::fuzz::fail(path_ + ": cannot write");
  }

 private:
  std::string path_;
  int file_;
};

void runOn(const std::string& input, const CrashFile& crash) {
  crash.set(input);
  // Exactly as long as the input, so that a sanitizer sees a read behind its end.
  const std::vector<std::uint8_t> bytes(input.begin(), input.end());
  ::alarm(kMaxSec);
  LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  ::alarm(0);
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments = parse(argc, argv);
  const std::vector<std::string> corpus = readCorpus(arguments.corpus);
  if (corpus.empty()) early_fusion::fuzz::fail("there is no corpus; test/fuzz/make_corpus.py writes one");
  const CrashFile crash("crash-" + fs::path(argv[0]).filename().string());
  for (const std::string& input : corpus) runOn(input, crash);
  for (int run = 0; run < arguments.runs; ++run) runOn(mutated(corpus, arguments.seed, run), crash);
  std::printf("%zu files and %d mutations\n", corpus.size(), arguments.runs);
  return 0;
}
