# Sourced by the other scripts, in the package's folder. Sets the folders of the build, `build` and `devel`. They are
# others for each value of the environment variable SANITIZE, so that the ordinary build stays as it is. Also sets what
# the sanitizers need at run time.
case "${SANITIZE:-}" in
  "") build=build devel=devel ;;
  address | undefined | address,undefined | thread)
    build=build-${SANITIZE//,/-}
    devel=$build/devel
    ;;
  *)
    echo "$(basename "$0"): SANITIZE is '$SANITIZE'; known are address, undefined, address,undefined and thread" >&2
    exit 2
    ;;
esac
if [ -n "${SANITIZE:-}" ]; then
  export LSAN_OPTIONS="${LSAN_OPTIONS:-print_suppressions=0:suppressions=$PWD/test/leak_sanitizer.supp}"
  export UBSAN_OPTIONS="${UBSAN_OPTIONS:-print_stacktrace=1}"
  export TSAN_OPTIONS="${TSAN_OPTIONS:-ignore_noninstrumented_modules=1:suppressions=$PWD/test/thread_sanitizer.supp}"
fi
