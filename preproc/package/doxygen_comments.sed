# Our plain comments as Doxygen's, line by line, for Doxygen alone: what stands above a thing, and what stands behind it.
# The first line of a header tells what the file is, and flags of the command keep both dashes.
1s|^// |/// \\file\n/// |
s|^( *)//( .*)?$|\1///\2|
/^ *[}#]/! s|^( *[^ /].*[^ ]  +)// (.*)$|\1///< \2|
/\/\/\//s|([ (])--([a-z])|\1\\--\2|g
