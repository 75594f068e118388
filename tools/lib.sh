# shellcheck shell=bash
# Shared by the scripts of this folder: installing what is missing and building. Sourced, not run.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
logs=$root/build/logs

# The packages of tools/packages.txt that are not installed, one a line.
missingPackages() {
    local package
    grep -v '^ *\(#\|$\)' "$root/tools/packages.txt" | while read -r package; do
        # shellcheck disable=SC2016  # dpkg-query expands it, not the shell
        [[ $(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || echo "$package"
    done
}

# Installs what is missing; touches neither apt nor the network when nothing is.
installPackages() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        echo "not a Debian system: taking it that what tools/packages.txt lists is there"
        return 0
    fi
    local missing=() asRoot=()
    mapfile -t missing < <(missingPackages)
    [[ ${#missing[@]} -gt 0 ]] || return 0
    if [[ $(id -u) != 0 ]]; then
        if ! command -v sudo >/dev/null; then
            echo "these packages are missing, and installing them needs root or sudo: ${missing[*]}" >&2
            return 1
        fi
        asRoot=(sudo)
    fi
    echo "installing ${missing[*]}"
    mkdir -p "$logs"
    if ! { "${asRoot[@]}" apt-get update && "${asRoot[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y --no-install-recommends "${missing[@]}"; } >"$logs/install.log" 2>&1; then
        tail -n 20 "$logs/install.log" >&2
        echo "installing failed; the whole story is in build/logs/install.log" >&2
        return 1
    fi
}

# buildPreset PRESET [TARGET]: configures and builds build/PRESET. Builds on after an error, to report them all.
buildPreset() {
    local preset=$1 target=${2:-all}
    if command -v ccache >/dev/null; then
        export CMAKE_CXX_COMPILER_LAUNCHER=ccache
        [[ -n ${HOME:-} ]] || export CCACHE_DIR=$root/build/ccache
    fi
    (cd "$root" && cmake --preset "$preset" && cmake --build "build/$preset" --target "$target" -j "$(nproc)" -- -k 0)
}
