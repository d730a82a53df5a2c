#!/bin/sh
# Tries a deb with tools that are not ours, installs it on this machine, uses it, and removes it without a rest.
# Usage: deb.sh FILE.deb [ROOT]
# ROOT is a bare system to try it in instead, such as debootstrap makes: debootstrap --variant=minbase bullseye ROOT
set -eu
deb=$1
root=${2:-}
work=$(mktemp -d)
out=/tmp/handscope-pictures
trap 'rm -rf "$work" "$root$out"' EXIT
# A container may leave man pages out.
page="-l $work/tree/usr/share/man/man1/handscope-record.1.gz"
there() { if [ -n "$root" ]; then chroot "$root" env DEBIAN_FRONTEND=noninteractive "$@"; else "$@"; fi; }

lintian --fail-on error "$deb"
dpkg-deb -x "$deb" "$work/tree"
desktop-file-validate "$work/tree/usr/share/applications/handscope.desktop"
appstreamcli validate --no-net "$work/tree/usr/share/metainfo/handscope.metainfo.xml"
if udevadm verify --help >/dev/null 2>&1; then
  udevadm verify "$work/tree/usr/lib/udev/rules.d/60-handscope.rules"
fi

there dpkg-query -L handscope >/dev/null 2>&1 && { echo "handscope is installed there already: nothing was tried"; exit 1; }
if [ -n "$root" ]; then
  cp "$deb" "$root/tmp/handscope.deb"
  deb=/tmp/handscope.deb
  page=handscope-record
  there apt-get update -qq
fi
there apt-get install -y --no-install-recommends "$deb" man-db >"$work/apt.txt" 2>&1 || { cat "$work/apt.txt"; exit 1; }
there which handscope | grep -qx /usr/bin/handscope
there handscope --version
there handscope watch --hand sim: --for 1 --json | tail -n 1
there handscope snapshot --view live --out "$out" >"$work/drawn.txt"
sha256sum <"$root$out/live.png"
# shellcheck disable=SC2086
there man --warnings $page >"$work/man.txt"
grep -q 'handscope record' "$work/man.txt" || { cat "$work/man.txt"; exit 1; }
there bash -c '. /usr/share/bash-completion/completions/handscope
  COMP_WORDS=(handscope tr) COMP_CWORD=1 COMP_LINE="handscope tr" COMP_POINT=12
  _handscope handscope tr handscope
  printf "%s\n" "${COMPREPLY[@]}"' >"$work/completed.txt"
grep -qx trial "$work/completed.txt" || { cat "$work/completed.txt"; exit 1; }
there dpkg-query -L handscope | while read -r path; do [ -d "$root$path" ] || echo "$path"; done >"$work/files.txt"
there apt-get remove -y --purge handscope >"$work/apt.txt" 2>&1
left=$(while read -r path; do if [ -e "$root$path" ]; then echo "$path"; fi; done <"$work/files.txt")
[ -z "$left" ] || { echo "left behind: $left"; exit 1; }
echo "installed, used and removed: $(wc -l <"$work/files.txt") files"
