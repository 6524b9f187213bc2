#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "early_fusion/core/error.h"

namespace early_fusion::model {

/// The text of the Error that `work` throws; "no error" if it throws none.
inline std::string errorOf(const std::function<void()>& work) {
  try {
    work();
  } catch (const core::Error& error) {
    return error.what();
  }
  return "no error";
}

inline void expectError(const std::function<void()>& work, const std::string& part) {
  const std::string error = errorOf(work);
  EXPECT_NE(error.find(part), std::string::npos) << error;
}

}  // namespace early_fusion::model
