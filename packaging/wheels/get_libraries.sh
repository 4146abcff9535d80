#!/bin/bash
# Gets what the core is built with by vcpkg, on Linux, macOS or Windows (in Git's Bash), into FOLDER/all, for
# CMAKE_PREFIX_PATH. Usage: get_libraries.sh FOLDER [PACKAGE...], of packages beside those that the core needs.
set -euo pipefail
folder=$1
shift
case $(uname -s)-$(uname -m) in
Linux-x86_64) triplet=x64-linux ;;
Linux-aarch64) triplet=arm64-linux ;;
Darwin-x86_64) triplet=x64-osx ;;
Darwin-arm64) triplet=arm64-osx ;;
*) triplet=x64-windows-static-md ;;  # its libraries end up within the module
esac
vcpkg=${VCPKG_INSTALLATION_ROOT-}
if [[ -z $vcpkg ]]; then
  vcpkg=$folder/vcpkg
  [[ -e $vcpkg ]] || git clone --depth 1 https://github.com/microsoft/vcpkg "$vcpkg"
  "$vcpkg/bootstrap-vcpkg.sh" -disableMetrics
fi
"$vcpkg/vcpkg" install --triplet "$triplet" --x-install-root="$folder" eigen3 nanoflann openmesh spectra "$@"
rm -rf "$folder/all"
cp -r "$folder/$triplet" "$folder/all"
