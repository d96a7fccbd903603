sed 's/^\([0-9.]*\) 7 /\1 8 /' "$SOURCE/logs/opterra_synthetic_02.data" > other
sort -s -n -k 1,1 "$SOURCE/logs/opterra_synthetic_01.data" other > flight.data; cp "$SOURCE/logs/opterra_synthetic_01.log" flight.log
for id in 7 8; do flightwatt parse flight.data --aircraft $id -o $id.csv 2> /dev/null || exit; done
flightwatt parse "$SOURCE/logs/opterra_synthetic_01.data" -o only.csv 2> /dev/null
cmp 7.csv only.csv && echo same; wc -l < 8.csv
