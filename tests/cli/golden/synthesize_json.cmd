flightwatt synthesize "$SOURCE/fits/mechanical/opterra-table1.toml" --flights 2 -o made --json > made.json || exit
python3 -c 'import json
for flight in json.load(open("made.json"))["flights"]: print(list(flight), flight["flight"], flight["bytes"] > 100000)'
