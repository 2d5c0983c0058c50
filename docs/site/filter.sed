# Makes the comments of our public headers Doxygen's: the first is the file's, an indented one is code.
1s,^// ,/// @file\n/// ,
s,^\( *\)//   ,\1///     ,
s,^\( *\)//\( .*\)\?$,\1///\2,
s,^\( *[^ /].*[;}\,{]\) *// ,\1  ///< ,
