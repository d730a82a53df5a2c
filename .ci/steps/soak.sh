# Days of virtual time and millions of inputs: our own code is compiled for speed. What it is linked with is the tests' own.
HANDSCOPE_SOAK=1 cargo test --locked --no-fail-fast --config profile.dev.package.handscope.opt-level=2 -- soak
