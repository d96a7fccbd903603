#pragma once

#include "telemetry/message_dictionary.h"

#include <string>

namespace flightwatt::test {

/// Messages of all field types, in three classes; ENERGY and ESTIMATOR as aircraft have them.
inline const std::string binary_protocol = R"xml(<protocol>
<msg_class name="telemetry" id="1">
<message name="TYPES" id="1"><field name="a" type="int8"/><field name="b" type="uint8"/><field name="c" type="int16"/>
<field name="d" type="uint16"/><field name="e" type="int32"/><field name="f" type="uint32"/><field name="g" type="int64"/>
<field name="h" type="uint64"/><field name="i" type="float"/><field name="j" type="double"/>
<field name="k" type="char"/></message>
<message name="ARRAYS" id="0x2"><field name="a" type="uint8[]"/><field name="b" type="float[3]"/>
<field name="c" type="char[]"/><field name="d" type="char[5]"/><field name="e" type="int16[]"/></message>
<message name="PONG" id="3"/>
<message name="ENERGY" id="37"><field name="throttle" type="uint8" unit="%"/><field name="voltage" type="float" unit="V"/>
<field name="current" type="float" unit="A"/><field name="power" type="float" unit="W"/>
<field name="charge" type="float" unit="Ah"/><field name="energy" type="float" unit="Wh"/></message>
<message NAME="ESTIMATOR" ID="42"><field NAME="z" TYPE="float" UNIT="m"/><field NAME="z_dot" TYPE="float" UNIT="m/s"/>
</message>
<message name="TIMESTAMP" id="129"><field name="timestamp" type="uint32"/></message>
<message name="NOT_SENT" id="300"/><message name="NOT_KNOWN" id="60"><field name="a" type="quaternion"/></message>
</msg_class>
<msg_class name="datalink" id="2"><message name="SETTING" id="4"><field name="index" type="uint8"/>
<field name="value" type="float"/></message></msg_class>
<class name="ground"><message name="NEW_AIRCRAFT" id="1"><field name="ac_id" type="string"/></message></class>
</protocol>)xml";

inline telemetry::MessageDictionary binary_dictionary() {
    return telemetry::parse_message_dictionary(binary_protocol, "messages.xml");
}

}  // namespace flightwatt::test
