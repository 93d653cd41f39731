// SPDX-License-Identifier: MIT
// The format of one target of FuzzFile.cpp, which is compiled once for all.
extern const char* const kFuzzExtension;
const char* const kFuzzExtension = OSGSKIN_FUZZ_EXTENSION;
