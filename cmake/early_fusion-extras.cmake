# Compiled into everything that uses the libraries; include/early_fusion/core/eigen_alignment.h says why.
add_compile_definitions(EIGEN_MAX_ALIGN_BYTES=64 EIGEN_MAX_STATIC_ALIGN_BYTES=64)
