// Writes and reads packets of MAVLink by node-mavlink: peer.mjs write FILE ID... | peer.mjs read FILE
// Both print a line for each packet: the message's number, and its fields with their values.
import fs from 'node:fs'
import { Readable } from 'node:stream'
import {
    MavLinkPacketParser, MavLinkPacketSplitter, MavLinkProtocolV1, MavLinkProtocolV2, ardupilotmega, common, minimal,
    standard
} from 'node-mavlink'

const registry = { ...minimal.REGISTRY, ...standard.REGISTRY, ...common.REGISTRY, ...ardupilotmega.REGISTRY }

function printed(message, id) {
    const fields = registry[id].FIELDS.flatMap(field => {
        const value = message[field.name]
        if (field.type === 'char[]') return [`${field.source}=${value}`]
        return Array.isArray(value) ? value.map((element, i) => `${field.source}[${i}]=${element}`) : [`${field.source}=${value}`]
    })
    console.log([id, ...fields].join(' '))
}

/// Values that differ from field to field and fit each type.
function filled(id, version) {
    const message = new registry[id]()
    registry[id].FIELDS.filter(field => version === 2 || !field.extension).forEach((field, i) => {
        const number = 3 + 2 * i
        const value = field.type.startsWith('uint64') ? BigInt(number) : field.type.startsWith('float') ? number + 0.5 : number
        if (field.type === 'char[]') message[field.name] = 'name'
        else message[field.name] = field.length ? Array.from({ length: field.length }, (_, k) => typeof value === 'bigint' ? value + BigInt(k) : value + k) : value
    })
    return message
}

const [, , command, file, ...ids] = process.argv
if (command === 'write') {
    const packets = []
    for (const protocol of [new MavLinkProtocolV2(7, 1), new MavLinkProtocolV1(7, 1)]) {
        const version = protocol instanceof MavLinkProtocolV1 ? 1 : 2
        ids.map(Number).filter(id => version === 2 || id < 256).forEach((id, i) => {
            const message = filled(id, version)
            packets.push(protocol.serialize(message, i))
            printed(message, id)
        })
    }
    fs.writeFileSync(file, Buffer.concat(packets))
} else {
    const packets = Readable.from([fs.readFileSync(file)]).pipe(new MavLinkPacketSplitter()).pipe(new MavLinkPacketParser())
    packets.on('data', packet => {
        const id = packet.header.msgid
        printed(packet.protocol.data(packet.payload, registry[id]), id)
    })
}
