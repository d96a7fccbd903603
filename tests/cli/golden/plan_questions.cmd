for mission in plan phased mechanical-only; do
    flightwatt plan "$SOURCE/missions/paper/$mission.toml" --longest-cruise 2> /dev/null; echo $?
    flightwatt plan "$SOURCE/missions/paper/$mission.toml" --largest-payload 2> /dev/null; echo $?
done
flightwatt plan "$SOURCE/missions/paper/phased.toml" --longest-cruise --json > cruise.json || exit
flightwatt plan "$SOURCE/missions/paper/phased.toml" --largest-payload --json > payload.json || exit
python3 -c 'import json
for file in ["cruise.json", "payload.json"]:
    answer = json.load(open(file)); print(list(answer), answer["limited_by"], abs(answer["residual_percent"]) < 1e-6)'
flightwatt plan "$SOURCE/missions/paper/invariant-32fps-448bit.toml" --largest-payload
