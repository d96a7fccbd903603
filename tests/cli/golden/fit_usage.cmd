log="$SOURCE/logs/opterra_synthetic_02.data"
for arguments in --order=0 --order=99 --order=3.5 --weights=best --weights='by' --weight=1 --weight=nobody=1 \
    --weight=opterra_synthetic_02:cruse=1 --weight=opterra_synthetic_02=-1 --weight=opterra_synthetic_02=0 \
    --weight=opterra_synthetic_02=nan '--weights uniform --weight opterra_synthetic_02=1' --min-periods=0 --min-periods=nan \
    --table=table.pdf; do
  flightwatt fit "$log" $arguments -o model.toml; echo $?
done
flightwatt fit "$log" "$log" -o model.toml; echo $?
ls
