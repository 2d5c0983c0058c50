#include <string>

// Does nothing: what the licence check looks at is what such a program is linked with.
int main(int, char** arguments) { return std::string(arguments[0]).empty() ? 1 : 0; }
