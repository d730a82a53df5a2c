cargo fmt --all --check
# Beside steps in which real time counts, and only with what they leave of the processors.
CLIPPY_CONF_DIR=.ci nice -n 19 cargo clippy --all-targets --locked -- -D warnings
