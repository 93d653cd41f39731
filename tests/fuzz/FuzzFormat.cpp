// SPDX-License-Identifier: MIT
// The format of one target of FuzzFile.cpp, which is compiled once for all targets.
#include "FuzzFormat.h"

const char* fuzzExtension() {
    return OSGSKIN_FUZZ_EXTENSION;
}
