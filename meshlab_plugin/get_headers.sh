#!/usr/bin/env bash
# Fetches what a MeshLab plugin is compiled against: MeshLab's headers, vcglib and ML_VERSION, out
# of Debian's source package of MeshLab. Nothing of it is installed.
#
#   get_headers.sh VERSION DESTINATION        e.g. get_headers.sh 2025.07 build/meshlab-2025.07
#
# SYMSURF_MESHLAB_SOURCE=all keeps the whole source, for building MeshLab itself.
set -euo pipefail

version=${1:?which MeshLab version, such as 2025.07}
destination=${2:?where to put the headers}
keep=${SYMSURF_MESHLAB_SOURCE:-headers}
stamp=$destination/.complete-$keep

[[ -e $stamp && $(<"$stamp") == "$version" ]] && exit 0

# A private apt state: the machine's own package lists and sources stay as they are.
state=$(mktemp -d)
trap 'rm -rf "$state"' EXIT
chmod 755 "$state"
mkdir -p "$state/lists/partial" "$state/download"
archive=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' |
  grep --invert-match security | sort --unique | head --lines 1)

private_apt() {
  local command=$1
  shift
  "$command" --quiet=2 \
    -o Dir::Etc::sourcelist="$state/sources.list" -o Dir::Etc::sourceparts=- \
    -o Dir::State::Lists="$state/lists" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= \
    -o Acquire::Check-Valid-Until=false -o Acquire::Retries=3 -o APT::Sandbox::User=root "$@"
}

# Suites move on; take the first that has the version asked for.
found=
for suite in sid testing trixie bookworm; do
  echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $archive $suite main" \
    >"$state/sources.list"
  private_apt apt-get update || continue
  found=$(private_apt apt-cache showsrc --only-source meshlab |
    sed --quiet "s/^Version: \($version[~+-].*\)/\1/p" | head --lines 1)
  [[ -n $found ]] && break
done
if [[ -z $found ]]; then
  echo "No Debian suite at $archive has the source of MeshLab $version." >&2
  exit 1
fi

(cd "$state/download" && private_apt apt-get source --download-only --tar-only "meshlab=$found")
wanted=()
[[ $keep == headers ]] &&
  wanted=(--wildcards '*/src/common/*' '*/src/vcglib/*' '*/ML_VERSION' '*/LICENSE.txt')
mkdir -p "$destination"
tar --extract --file "$state"/download/meshlab_*.orig.tar.* --directory "$destination" \
  --strip-components=1 "${wanted[@]}"
echo "$version" >"$stamp"
echo "MeshLab $(<"$destination/ML_VERSION"): headers in $destination"
