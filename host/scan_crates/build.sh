#!/bin/sh
# build.sh CARGO RUSTC FOLDER: builds the library of the crate here into FOLDER.
set -eu
# Where OpenSSL's variable names the certificates, Cargo wants them under a name of its own.
if [ -n "${SSL_CERT_FILE:-}" ] && [ -z "${CARGO_HTTP_CAINFO:-}" ]; then
  export CARGO_HTTP_CAINFO="$SSL_CERT_FILE"
fi
RUSTC=$2 RUSTFLAGS='' exec "$1" build --locked --release --quiet \
  --manifest-path "$(dirname "$0")/Cargo.toml" --target-dir "$3"
