// SPDX-License-Identifier: MIT
// The format of one target of FuzzFile.cpp, which is compiled once for all targets.
const char* fuzzExtension();

const char* fuzzExtension() {
    return OSGSKIN_FUZZ_EXTENSION;
}
