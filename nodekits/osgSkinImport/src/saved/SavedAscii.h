// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAVEDASCII_H
#define OSGSKINIMPORT_SAVEDASCII_H 1

#include "saved/SavedText.h"

#include <string>

namespace osgSkin {

/// The layout of `.osgt` files.
class SavedAscii : public SavedText {
public:
    using SavedText::SavedText;

    void readMark(osgDB::ObjectMark& mark) override;
    void readWrappedString(std::string& text) override;
    bool matchString(const std::string& text) override;
    void advanceToCurrentEndBracket() override;

protected:
    std::string nextWord() override;
    std::string nextName(const std::string&) override { return nextWord(); }

private:
    void skipSpace();
};

} // namespace osgSkin

#endif
