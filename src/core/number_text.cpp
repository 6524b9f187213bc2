#include "early_fusion/core/number_text.h"

#include <charconv>
#if !defined(__cpp_lib_to_chars)
#include <locale.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <locale>
#include <sstream>
#endif

namespace early_fusion::core {

#if defined(__cpp_lib_to_chars)

std::string shortestText(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, result.ptr);
}

std::optional<double> parseDouble(const std::string& text) {
  double value{};
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

#else  // libstdc++ before GCC 11 has both functions for integers only

namespace {

std::string format(double value, std::ios_base::fmtflags notation, int decimals) {
  std::ostringstream stream;
  stream.imbue(std::locale::classic());
  stream.setf(notation, std::ios_base::floatfield);
  stream.precision(decimals);
  stream << value;
  return stream.str();
}

}  // namespace

std::string shortestText(double value) {
  constexpr int kMaxDecimals = 16;  // of the scientific notation; they distinguish all numbers
  int decimals = 0;
  std::string scientific = format(value, std::ios_base::scientific, decimals);
  while (decimals < kMaxDecimals && parseDouble(scientific) != value) {
    scientific = format(value, std::ios_base::scientific, ++decimals);
  }
  const std::size_t exponent = scientific.find('e');
  if (exponent == std::string::npos) return scientific;  // inf, nan
  const int decimals_of_fixed = std::max(0, decimals - std::stoi(scientific.substr(exponent + 1)));
  const std::string fixed = format(value, std::ios_base::fixed, decimals_of_fixed);
  return fixed.size() <= scientific.size() ? fixed : scientific;
}

std::optional<double> parseDouble(const std::string& text) {
  static const locale_t locale = newlocale(LC_ALL_MASK, "C", nullptr);
  // strtod() also takes leading spaces, a plus sign and hexadecimal numbers.
  if (text.empty() || text.find_first_of(" \f\n\r\t\v+") == 0 || text.find_first_of("xX") != std::string::npos) {
    return std::nullopt;
  }
  char* end = nullptr;
  errno = 0;
  const double value = strtod_l(text.c_str(), &end, locale);
  if (end != text.data() + text.size() || (errno == ERANGE && std::isinf(value))) return std::nullopt;
  return value;
}

#endif

}  // namespace early_fusion::core
