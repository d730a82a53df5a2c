#!/bin/sh
# Tries a deb with tools that are not ours, installs it on this machine, uses it, and removes it without a rest.
# Usage: deb.sh FILE.deb
set -eu
deb=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

lintian --fail-on error "$deb"
dpkg-deb -x "$deb" "$work/tree"
desktop-file-validate "$work/tree/usr/share/applications/handscope.desktop"
appstreamcli validate --no-net "$work/tree/usr/share/metainfo/handscope.metainfo.xml"
if udevadm verify --help >/dev/null 2>&1; then
  udevadm verify "$work/tree/usr/lib/udev/rules.d/60-handscope.rules"
fi

dpkg-query -L handscope >/dev/null 2>&1 && { echo "handscope is installed here already: nothing was tried"; exit 1; }
apt-get install -y --no-install-recommends "$deb" >"$work/apt.txt" 2>&1 || { cat "$work/apt.txt"; exit 1; }
test "$(command -v handscope)" = /usr/bin/handscope
handscope --version
handscope watch --hand sim: --for 1 --json | tail -n 1
man --warnings -l "$work/tree/usr/share/man/man1/handscope-record.1.gz" >"$work/man.txt"
grep -q 'handscope record' "$work/man.txt" || { cat "$work/man.txt"; exit 1; }
bash -c '. /usr/share/bash-completion/completions/handscope
  COMP_WORDS=(handscope tr) COMP_CWORD=1 COMP_LINE="handscope tr" COMP_POINT=12
  _handscope handscope tr handscope
  printf "%s\n" "${COMPREPLY[@]}"' >"$work/completed.txt"
grep -qx trial "$work/completed.txt" || { cat "$work/completed.txt"; exit 1; }
dpkg-query -L handscope | while read -r path; do [ -d "$path" ] || echo "$path"; done >"$work/files.txt"
apt-get remove -y --purge handscope >"$work/apt.txt" 2>&1
left=$(while read -r path; do if [ -e "$path" ]; then echo "$path"; fi; done <"$work/files.txt")
[ -z "$left" ] || { echo "left behind: $left"; exit 1; }
echo "installed, used and removed: $(wc -l <"$work/files.txt") files"
