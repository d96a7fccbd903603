mkdir in && cp "$SOURCE"/logs/opterra_synthetic_0[1-4].* in/
awk '$3 == "ENERGY" {$6 += 30; $7 = $5 * $6} {print}' "$SOURCE/logs/opterra_synthetic_04.data" >in/opterra_synthetic_04.data
flightwatt batch in -o out --jobs 1 --json 2>warnings >summary.json; echo "exit $?"
grep -v '^flightwatt-batch: \[' warnings
cut -d, -f1,3,11 out/flights.csv | grep _04
python3 -c 'import json; print([f["flight"] for f in json.load(open("summary.json"))["flights"]])'
echo "kept:"
flightwatt batch in -o out --jobs 1 --json --keep opterra_synthetic_04 2>/dev/null >summary.json; echo "exit $?"
python3 -c 'import json; print([f["flight"] for f in json.load(open("summary.json"))["flights"]])'
flightwatt batch in -o out --keep opterra_synthetic_9; echo "exit $?"
flightwatt fit in/*.data -o m.toml --json 2>&1 | grep absurd
