/* A fuzz target: one function, told bytes, that must come back whatever they are.
 *
 * With PSCN_FUZZ each target is linked with libFuzzer (clang), which makes the bytes up; else with replay.c, which
 * reads them from the files it is given. A failed assert is a crash too; either ends what takes too long.
 */
#ifndef PSCN_TESTS_FUZZ_TARGET_H
#define PSCN_TESTS_FUZZ_TARGET_H

#undef NDEBUG
#include <assert.h>
#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
