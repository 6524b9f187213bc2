# The target CLI11::CLI11, which is headers only. Debian 11 and Ubuntu 20.04 have no package of it. There, Debian 12's
# source is downloaded. Offline: -DFETCHCONTENT_SOURCE_DIR_CLI11=FOLDER names the unpacked source.
find_package(CLI11 QUIET)
if(NOT CLI11_FOUND)
  message(STATUS "CLI11 was not found (Debian 12: libcli11-dev): downloading it")
  include(FetchContent)
  set(pool debian/pool/main/c/cli11/cli11_2.1.2+ds.orig.tar.xz)
  fetchcontent_declare(cli11 URL http://deb.debian.org/${pool} http://archive.debian.org/${pool}
    URL_HASH SHA256=8143d20b688e98ccce8e24562d3b68e5f47c12e896c42c7ca8553dbde5bed55d)
  fetchcontent_getproperties(cli11)
  if(NOT cli11_POPULATED)
    fetchcontent_populate(cli11)
  endif()
  add_library(CLI11::CLI11 INTERFACE IMPORTED GLOBAL)
  set_target_properties(CLI11::CLI11 PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${cli11_SOURCE_DIR}/include")
endif()
