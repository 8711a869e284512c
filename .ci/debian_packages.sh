# Sourced by run.sh, test.sh, .ci/run and .ci/nightly: what to install on Debian 12, and a function
# that does so.
# Where every package is there already, apt is not called.

# What the build looks for with find_package; the tests are part of it, hence GoogleTest.
build_packages=(
  cmake g++ ninja-build pkg-config
  libcgal-dev libexpected-dev libtet1.5-dev
  libocct-data-exchange-dev
  libdxflib-dev libpugixml-dev nlohmann-json3-dev zlib1g-dev
  libboost-dev libcli11-dev libcpp-httplib-dev libpqxx-dev libseccomp-dev libsodium-dev libspdlog-dev
  libsqlitecpp-dev libssl-dev prometheus-cpp-dev
  libgtest-dev
)
# Bundles the pages. Other distributions of node bring npm along, and clash with Debian's.
command -v npm > /dev/null || build_packages+=(npm)
# What tests run.
test_packages=(
  calculix-ccx chromium curl gmsh openssl postgresql python3 python3-matplotlib python3-meshio python3-numpy
  python3-scipy python3-yaml)
# What the checks of .ci/run use beyond that.
check_packages=(clang-format-14 clang-tidy-14)
# What .ci/nightly uses: clang with libFuzzer.
nightly_packages=(clang-14 libclang-rt-14-dev)

ensure_packages() {
  if ! command -v dpkg-query > /dev/null; then
    echo "$0: not a Debian system; going on in the hope that this is installed: $*" >&2
    return 0
  fi
  local installed missing=() as_root=() package
  installed=" $(dpkg-query -W -f='${db:Status-Abbrev}${Package}\n' 2> /dev/null |
    sed -n 's/^ii *//p' | tr '\n' ' ')"
  for package in "$@"; do
    [[ $installed == *" $package "* ]] || missing+=("$package")
  done
  ((${#missing[@]})) || return 0

  if ((EUID != 0)); then
    if ! command -v sudo > /dev/null; then
      echo "$0: Debian packages are missing and there is no sudo. As root:" >&2
      echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "$0: installing ${missing[*]}" >&2
  # A source that cannot be reached must not stop the others.
  "${as_root[@]}" apt-get update >&2 || echo "$0: apt-get update failed; trying to go on" >&2
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --no-install-recommends "${missing[@]}" >&2 < /dev/null
}

# Configures the release preset where that was not done yet, and builds targets: all, or those named,
# which then goes without a word if the program is there already.
build_release() {
  local quiet=() targets=()
  [[ -f build/release/build.ninja ]] || cmake --preset release >&2
  (($#)) && targets=(--target "$@")
  (($#)) && [[ -x build/release/symcell ]] && quiet=(-- --quiet)
  cmake --build --preset release "${targets[@]}" "${quiet[@]}" >&2
}
