#!/usr/bin/env bash
# Every test: the release build's, then the import of real CAD files under AddressSanitizer where there are any. The summary
# comes last.
set -uo pipefail
cd "$(dirname "$0")/.."

log=build/test-output.log
ctest --preset release --parallel 2 --output-log "$log"
result=$?

if [ -n "${CATOPTRA_CORPUS:-}" ]; then
  echo
  echo "Import of the files in \$CATOPTRA_CORPUS under AddressSanitizer"
  cmake --preset asan >/dev/null && cmake --build --preset asan --target test_cad_import_corpus &&
    ctest --preset asan -L corpus_import
  asan=$?
  asan_text=$([ $asan -eq 0 ] && echo "passed" || echo "FAILED")
else
  asan=0
  asan_text="not run: CATOPTRA_CORPUS does not name a folder of CAD files, so no corpus test ran either"
fi

echo
echo "Summary"
sed -n '/^[0-9]*% tests passed/,$p' "$log"
echo "AddressSanitizer corpus: $asan_text"
[ $result -eq 0 ] && [ $asan -eq 0 ]
