# shellcheck shell=bash disable=SC2034
# Installs Debian packages where they are missing. Sourced by quickstart.sh and by tests/run.sh:
#
#   install_packages NAME...
#
# Uses the network only if something is missing. If root is needed, it fails with the command to run.

# A build folder that was configured otherwise, by hand, is not changed.
export CMAKE_GENERATOR=Ninja

# What building and running pscn needs.
BUILD_PACKAGES=(cmake ninja-build gcc g++ libc6-dev pkg-config flex bison libopenimageio-dev libpng-dev
  libjansson-dev)

install_packages() {
  if ! command -v dpkg-query >/dev/null; then
    echo "This is not a Debian system; please install the equivalents of these Debian packages: $*" >&2
    return 0
  fi
  local name missing=()
  for name in "$@"; do
    if [ "$(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null)" != installed ]; then
      missing+=("$name")
    fi
  done
  if [ ${#missing[@]} -eq 0 ]; then
    return 0
  fi
  if [ "$(id -u)" -ne 0 ]; then
    {
      echo "Some packages are missing, and only root can install them. Please run, as root:"
      echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}"
      echo "and then start this script again."
    } >&2
    return 1
  fi
  echo "Installing ${missing[*]}"
  export DEBIAN_FRONTEND=noninteractive
  apt-get -qq update || echo "apt-get update had errors; trying to install all the same" >&2
  apt-get -qq install --yes --no-install-recommends "${missing[@]}" >/dev/null
}
