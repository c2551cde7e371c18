#!/usr/bin/env bash
# The symbols that libuplift exports are those of its list and of its header, and the header compiles as C99 and as C++98: check_exports.sh LIBRARY
set -euo pipefail
cd "$(dirname "$0")/.."
library="${1:?usage: scripts/check_exports.sh LIBRARY}"
listed=$(grep -oE 'uplift_[a-z_0-9]+' src/uplift/capi/exports.map | sort)
declared=$(grep -A1 '^UPLIFT_API' include/uplift.h | grep -oE '\buplift_[a-z_0-9]+\(' | tr -d '(' | sort)
exported=$(nm -D --defined-only "$library" | awk '$2 != "A" {print $3}' | sort)
diff <(echo "$listed") <(echo "$exported") || { echo "check_exports.sh: exported symbols (>) differ from src/uplift/capi/exports.map (<)"; exit 1; }
diff <(echo "$listed") <(echo "$declared") || { echo "check_exports.sh: declarations of include/uplift.h (>) differ from src/uplift/capi/exports.map (<)"; exit 1; }
gcc -std=c99 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -x c include/uplift.h
g++ -std=c++98 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -x c++ include/uplift.h
echo "$(echo "$exported" | wc -l) symbols, as listed and declared"
