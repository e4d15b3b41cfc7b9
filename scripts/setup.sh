# Sourced by the other scripts: makes .venv with what a run needs, or with all that development needs.
# Nothing is done again while pyproject.toml and constraints.txt stay as they are.
# shellcheck shell=bash

cd "$(dirname "${BASH_SOURCE[0]}")/.."

_need_packages() {
    # Debian packages: with the rights to install them do so, else say what is missing.
    if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
        echo "installing Debian packages: $*"
        apt-get update -qq
        DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >/dev/null
    else
        echo "please install: sudo apt-get install $*" >&2
        return 1
    fi
}

_has_library() { PATH="$PATH:/sbin:/usr/sbin" ldconfig -p | grep -q "$1"; }

declare -A extra=([run]="" [docs]="[docs]" [dev]="[dev]" [exhaustive]="[exhaustive]")
declare -A contained_in=([run]="run docs dev exhaustive" [docs]="docs exhaustive" [dev]="dev exhaustive" [exhaustive]="exhaustive")

_find_python() {
    local candidate
    for candidate in python3 python3.13 python3.12 python3.11; do
        if command -v "$candidate" >/dev/null &&
            "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
            echo "$candidate"
            return
        fi
    done
    echo "Python 3.11 or later is needed" >&2
    return 1
}

compile_kernels() {
    # Pictures may be impossible here, which doctor would end with.
    echo "compiling kernels for this computer, which takes one to two minutes"
    .venv/bin/twin doctor --compile >/dev/null || true
}

_is_set_up() {
    local larger
    for larger in ${contained_in[$1]}; do
        [ "$(cat ".venv/stamp-$larger" 2>/dev/null)" != "$2" ] || return 0
    done
    return 1
}

# setup_environment [dev|docs|exhaustive]: with that extra, or with what a run needs alone.
setup_environment() {
    local python stamp wanted="${1:-run}" byte_code=()
    python=$(_find_python)
    "$python" -c 'import ensurepip, venv' 2>/dev/null || _need_packages python3-venv
    # Off-screen pictures: EGL with Mesa's software drivers. Without them all but pictures works.
    if ! _has_library libEGL.so.1 || ! _has_library libEGL_mesa.so.0; then
        _need_packages libegl1 libegl-mesa0 libgl1-mesa-dri || true
    fi
    stamp=$(cat pyproject.toml constraints.txt | sha256sum | cut -d' ' -f1)
    if ! _is_set_up "$wanted" "$stamp"; then
        echo "setting up .venv"
        [ -x .venv/bin/python ] || "$python" -m venv .venv
        # By the environment, so that the isolated build keeps to the same versions.
        # Python makes byte code of what it loads, unless it is told not to: for all packages it is half of the work.
        [ -n "${PYTHONDONTWRITEBYTECODE:-}" ] || byte_code=(--no-compile)
        PIP_CONSTRAINT="$PWD/constraints.txt" MILL_TWIN_KERNELS=0 .venv/bin/python -m pip install \
            --quiet --disable-pip-version-check "${byte_code[@]}" --editable ".${extra[$wanted]}"
        echo "$stamp" >".venv/stamp-$wanted"
    fi
    PATH="$PWD/.venv/bin:$PATH"
}

setup_vulkan() {
    # For the tests of the Filament renderer, which are left out without a Vulkan driver.
    compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null ||
        _need_packages libvulkan1 mesa-vulkan-drivers || true
}

setup_browser() {
    # For the tests of pages, which are left out without one; axe-core holds them to accessibility.
    command -v chromium >/dev/null || _need_packages chromium || true
    .venv/bin/python scripts/fetch_three.py --axe || true
}
