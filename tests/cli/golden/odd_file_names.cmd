newline=$(printf 'a\nb')
for name in 'a blank' "quote's\"" "$newline" "$(printf 'not-utf8-\377')" -dash; do
  cp "$SOURCE/logs/opterra_synthetic_02.data" "./$name.data"; cp "$SOURCE/logs/opterra_synthetic_02.log" "./$name.log"
  for stage in parse segment; do
    flightwatt $stage --json -- "$name.data" > summary.json || exit
    python3 -c 'import json; print(ascii(json.load(open("summary.json"))["flight"]))'
  done
done
flightwatt batch . --jobs 1 -o out > first.txt 2> /dev/null || exit; cp out/flights.csv first.csv
flightwatt batch . --jobs 1 -o out > second.txt || exit
cmp first.txt second.txt && cmp first.csv out/flights.csv && echo same
