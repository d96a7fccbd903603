flightwatt batch "$SOURCE/logs" --jobs 1 -o out > first.txt 2> /dev/null || exit
cp -r out before
flightwatt batch "$SOURCE/logs" --jobs 1 -o out > second.txt || exit
cmp first.txt second.txt && diff -r before out && echo same
