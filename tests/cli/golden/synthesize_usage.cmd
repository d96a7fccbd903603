model="$SOURCE/fits/mechanical/opterra-table1.toml"
for arguments in --flights=-1 --flights=0 --flights=99999999 --seed=-1 --spread=nan --spread=inf --spread=-1 --current-noise=inf \
    --name=../x '--flights 1 --flights 2'; do
  flightwatt synthesize "$model" $arguments -o made; echo $?
done
flightwatt synthesize "$model"; echo $?
flightwatt synthesize "$model" "$model" -o made; echo $?
flightwatt synthesize; echo $?
ls
