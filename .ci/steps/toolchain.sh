if ! command -v cc >/dev/null; then
  apt-get update -qq
  apt_install "gcc libc6-dev" || { cat "$out/apt.txt"; exit 1; }
fi
cargo --version
