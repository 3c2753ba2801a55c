#!/bin/bash
# install.sh BUILD CC CXX [FLAG...]: libpscn as others find it. Installs it into an empty folder, and moves that. Checks
# there that exactly the functions of pscn.h are exported; that nothing which prints, ends the process or loads
# libraries is used; that the header compiles as C and C++ without a warning; and that the examples, built with
# pkg-config and with find_package, static and shared, give the right answers.
set -uo pipefail
build=$1 cc=$2 cxx=$3
shift 3
flags="$*"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "$build" --prefix "$folder/first" >/dev/null || exit 1
mv "$folder/first" "$folder/moved"
prefix=$folder/moved
examples=$PSCN_SOURCE_DIR/examples/library
shared=$(find "$prefix" -name libpscn.so) static=$(find "$prefix" -name libpscn.a)
failed=0
say() { echo "$*"; failed=1; }
cd "$folder" || exit 1

# Names.
"$cc" -E -P "$prefix/include/pscn.h" | grep -o '\bpscn_[a-z_]*(' | tr -d '(' | sort >declared
[ "$(wc -l <declared)" -ge 15 ] || say "few functions are declared: $(cat declared)"
diff declared <(nm -D --defined-only "$shared" | sed -n 's/.* T \([^@]*\).*/\1/p' | sort) || say "libpscn.so exports other names"
diff declared <(nm -g --defined-only "$static" | sed -n 's/.* [TDBRVW] //p' | sort) || say "libpscn.a exports other names"
[ "$(readelf -d "$shared" | sed -n 's/.*(SONAME).*\[\(.*\)\]/\1/p')" = "$(basename "$(find "$prefix" -name 'libpscn.so.*.*' ! -name 'libpscn.so.*.*.*')")" ] ||
  say "its soname is no file"
case $flags in
  *sanitize*) ;; # they bring more along
  *)
    nm -D --undefined-only "$shared" | sed 's/.* [Uw] //; s/@.*//' | sort >wanted
    # (only builds for tests use __assert_fail)
    forbidden=$(grep -x -E '_?_?exit|_Exit|abort|quick_exit|v?f?d?printf|__v?f?printf_chk|f?puts|f?putc|putchar|fwrite|perror|stderr|write|system|fork|exec.*|kill|raise|signal|sigaction|setlocale|dlopen|pthread_create|setrlimit' wanted)
    [ -z "$forbidden" ] || say "libpscn.so asks for" $forbidden
    needed=$(readelf -d "$shared" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | grep -v -E '^lib(c|m)\.so|^ld-linux|^libgcc_s')
    [ -z "$needed" ] || say "libpscn.so needs" $needed
    ;;
esac

# The header alone.
printf '#include <pscn.h>\n#include <pscn.h>\nstruct pscn_options options = PSCN_OPTIONS;\n' >header.c
cp header.c header.cpp
for standard in c11 c17; do
  "$cc" -std=$standard -Wall -Wextra -pedantic -Werror -I"$prefix/include" -c header.c || say "the header is no $standard"
done
for standard in c++11 c++17; do
  "$cxx" -std=$standard -Wall -Wextra -pedantic -Werror -I"$prefix/include" -c header.cpp || say "the header is no $standard"
done

# The example, with pkg-config.
export PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name pscn.pc)")
export LD_LIBRARY_PATH=$(dirname "$shared")
warnings="-std=c11 -Wall -Wextra -pedantic -Werror $flags"
$cc $warnings "$examples/inside.c" $(pkg-config --cflags --libs pscn) -lm -o shared || say "pkg-config does not lead there"
$cc $warnings "$examples/inside.c" $(pkg-config --cflags pscn) "$static" $(pkg-config --libs --static pscn | grep -o -e '-lm') -o static ||
  say "the static library does not link"
cat >ball <<'END'
2601 lines, 2053 meet the model, 0 have no proven number of hits
0 got in and not out
volume 4.1914
END
for program in shared static; do
  ./$program 51 >said || say "$program failed"
  diff ball said || say "$program says something else"
done
./shared 20 "$PSCN_SOURCE_DIR/scenes/bent.pscn" >said && say "a patch that is open has no leak: $(cat said)"
./shared 5 /nowhere >said 2>errors && say "a scene that is nowhere"
grep -q "/nowhere: there is no such file" errors || say "nobody says where: $(cat errors)"

# And with find_package.
mkdir -p consumer && cat >consumer/CMakeLists.txt <<END
cmake_minimum_required(VERSION 3.13)
project(consumer C)
find_package(pscn 0.1 REQUIRED)
add_executable(with_shared $examples/inside.c)
target_link_libraries(with_shared pscn::pscn m)
add_executable(with_static $examples/inside.c)
target_link_libraries(with_static pscn::static)
END
cmake -S consumer -B consumer/build -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_C_COMPILER="$cc" -DCMAKE_C_FLAGS="$flags" >log 2>&1 &&
  cmake --build consumer/build >>log 2>&1 || { cat log; say "find_package does not lead there"; }
for program in consumer/build/with_shared consumer/build/with_static; do
  ./$program 51 | diff ball - || say "$program says something else"
done
exit "$failed"
