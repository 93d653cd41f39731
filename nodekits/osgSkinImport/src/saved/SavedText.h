// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAVEDTEXT_H
#define OSGSKINIMPORT_SAVEDTEXT_H 1

#include "saved/SavedInput.h"

#include <string>

namespace osgSkin {

/// Saved files of words, `.osgt` and `.osgx`: every value is one.
class SavedText : public SavedInput {
public:
    using SavedInput::SavedInput;

    bool isBinary() const override { return false; }
    void readBool(bool& value) override { value = truth(); }
    void readChar(char& value) override { value = static_cast<char>(number()); }
    void readSChar(signed char& value) override { value = static_cast<signed char>(number()); }
    void readUChar(unsigned char& value) override { value = static_cast<unsigned char>(number()); }
    void readShort(short& value) override { value = static_cast<short>(number()); }
    void readUShort(unsigned short& value) override {
        value = static_cast<unsigned short>(number());
    }
    void readInt(int& value) override { value = took(static_cast<int>(number())); }
    void readUInt(unsigned& value) override { value = took(static_cast<unsigned>(number())); }
    void readLong(long& value) override { value = number(); }
    void readULong(unsigned long& value) override { value = static_cast<unsigned long>(number()); }
    void readFloat(float& value) override;
    void readDouble(double& value) override;
    void readString(std::string& value) override { value = took(nextWord()); }
    void readStream(std::istream& (*)(std::istream&)) override {}
    void readBase(std::ios_base& (*)(std::ios_base&)) override {}
    void readGLenum(osgDB::ObjectGLenum& value) override;
    void readProperty(osgDB::ObjectProperty& property) override;
    void readCharArray(char* bytes, unsigned size) override;

protected:
    static constexpr const char* kSpace = " \t\r\n\v\f";

    /// What stands up to the next space; nothing, and a refusal, at the end.
    virtual std::string nextWord() = 0;
    /// What is called `expected` here, in the letters of OSG's classes.
    virtual std::string nextName(const std::string& expected) = 0;

    /// \throw osgSkin::Error with the line, without the file's name
    [[noreturn]] void refuseWord(const std::string& word, const char* expected) const;

private:
    long number();
    bool truth();
    int valueOf(const std::string& table);
};

} // namespace osgSkin

#endif
