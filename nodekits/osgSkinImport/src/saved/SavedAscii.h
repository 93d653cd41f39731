// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAVEDASCII_H
#define OSGSKINIMPORT_SAVEDASCII_H 1

#include "saved/SavedText.h"

#include <string>
#include <vector>

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
    /// OSG unpacks them before it looks, and would lose what it has.
    void expectPixelsEnd();

    std::string _word;              ///< the last that was read
    std::vector<std::string> _open; ///< what stood before each bracket that is open
};

} // namespace osgSkin

#endif
