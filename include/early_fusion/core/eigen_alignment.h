#pragma once

#include <Eigen/Core>

/// By default, Eigen's alignment follows the compiler's flags. A program that is compiled for another processor than
/// these libraries would lay out and free their matrices differently, and crash. So all who share Eigen's types with
/// them have this alignment; find_package(catkin COMPONENTS early_fusion) sets it.
static_assert(
    EIGEN_DEFAULT_ALIGN_BYTES == 64 && EIGEN_MAX_STATIC_ALIGN_BYTES == 64,
    "early_fusion needs -DEIGEN_MAX_ALIGN_BYTES=64 -DEIGEN_MAX_STATIC_ALIGN_BYTES=64 in every file of the "
    "program: find_package(catkin REQUIRED COMPONENTS early_fusion) before its targets, or compile with both");
