// Its target precompiles headers; see CMakeLists.txt.
