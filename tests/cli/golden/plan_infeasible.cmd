cp -r "$SOURCE/fits" "$SOURCE/missions" .
sed -i 's/^reserve_soc_percent = .*/reserve_soc_percent = 9/' missions/paper/plan.toml
flightwatt plan missions/paper/plan.toml --json -o schedule.toml > plan.json; code=$?
python3 -c 'import json
def show(value): return round(value, 4) if isinstance(value, float) else value
plan = json.load(open("plan.json")); shortfall = plan.pop("shortfall")
for key, value in [*plan.items(), *shortfall.items()]: print(key, show(value))'
ls
flightwatt compare missions/paper/p*.toml; echo $?
exit $code
