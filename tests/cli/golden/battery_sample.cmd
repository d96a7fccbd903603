flightwatt battery "$SOURCE"/logs/*.data --capacity 3.2 -o pack.toml && grep -v "_v = \|_percent = \|interval\|= \[" pack.toml | cut -c 1-100 | sed "s/\(= [0-9.]\{6\}\)[0-9e-]*/\1/"
