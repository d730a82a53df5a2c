#!/usr/bin/env python3
"""Programs of others at the gateway, two at a time: gateway_clients.py HANDSCOPE

Each of the pair reads the angles for a while, as fast as it can, and asks once for what it may not do. Both must read what the hand says
all the time, and none may move it. A program that is not installed is skipped and told.
"""
import itertools, json, re, subprocess, sys, time
from multiprocessing import Process, Queue

ANGLE_ACT, ANGLE_SET, JOINTS, UNIT = 1546, 1486, 6, 1
FOR_S = 0.5
TELLS_NOTHING = None


def pymodbus(host, port):
    from pymodbus.client import ModbusTcpClient

    client = ModbusTcpClient(host, port=port)
    assert client.connect()
    read = lambda: client.read_holding_registers(ANGLE_ACT, count=JOINTS).registers
    return read, lambda: client.write_registers(ANGLE_SET, [0] * JOINTS).exception_code


def pymodbustcp(host, port):
    from pyModbusTCP.client import ModbusClient

    client = ModbusClient(host=host, port=port, unit_id=UNIT, auto_open=True)

    def write():
        assert not client.write_multiple_registers(ANGLE_SET, [0] * JOINTS)
        return client.last_except

    return lambda: client.read_holding_registers(ANGLE_ACT, JOINTS), write


def umodbus(host, port):
    import socket
    from umodbus import exceptions
    from umodbus.client import tcp

    client = socket.create_connection((host, port))
    ask = lambda message: tcp.send_message(message, client)

    def write():
        try:
            ask(tcp.write_multiple_registers(UNIT, ANGLE_SET, [0] * JOINTS))
        except exceptions.ModbusError as error:
            return error.error_code
        return 0

    return lambda: ask(tcp.read_holding_registers(UNIT, ANGLE_ACT, JOINTS)), write


def modbus_tk(host, port):
    import modbus_tk.defines as defines
    from modbus_tk import modbus, modbus_tcp

    client = modbus_tcp.TcpMaster(host, port)
    client.set_timeout(5)

    def write():
        try:
            client.execute(UNIT, defines.WRITE_MULTIPLE_REGISTERS, ANGLE_SET, output_value=[0] * JOINTS)
        except modbus.ModbusError as error:
            return error.get_exception_code()
        return 0

    read = lambda: client.execute(UNIT, defines.READ_HOLDING_REGISTERS, ANGLE_ACT, JOINTS)
    return read, write


def easymodbus(host, port):
    from easymodbus.modbus_client import ModbusClient

    client = ModbusClient(host, port)
    client.connect()

    def write():
        client.write_multiple_registers(ANGLE_SET, [0] * JOINTS)
        return TELLS_NOTHING  # It does not look at the answer.

    return lambda: client.read_holding_registers(ANGLE_ACT, JOINTS), write


def pylibmodbus(host, port):
    from pylibmodbus import ModbusTcp

    client = ModbusTcp(host, port)
    client.connect()

    def write():
        try:
            client.write_registers(ANGLE_SET, [0] * JOINTS)
        except Exception as error:
            return 6 if "busy" in str(error).lower() else str(error)
        return 0

    return lambda: list(client.read_registers(ANGLE_ACT, JOINTS)), write


def said(command):
    done = subprocess.run(command, capture_output=True, text=True, timeout=20)
    return done.stdout + done.stderr


def mbpoll(host, port):
    at = ["mbpoll", "-0", "-1", "-q", "-a", str(UNIT), "-p", str(port), "-r"]

    def read():
        words = said([*at, str(ANGLE_ACT), "-c", str(JOINTS), host])
        return [int(value) for value in re.findall(r"\[\d+\]:\s+(\d+)", words)]

    def write():
        words = said([*at, str(ANGLE_SET), host] + ["0"] * JOINTS)
        return 6 if "busy" in words.lower() else words

    return read, write


def modbus_cli(host, port):
    at = [sys.executable.rsplit("/", 1)[0] + "/modbus", "-s", str(UNIT), f"{host}:{port}"]

    def read():
        words = said(at + [f"h@{ANGLE_ACT + joint}/H" for joint in range(JOINTS)])
        return [int(value) for value in re.findall(r": (\d+)", words)]

    def write():
        words = said(at + [f"h@{ANGLE_SET}/H=0"])
        return 6 if re.search("busy|0x06|exception", words, re.I) else words

    return read, write


PROGRAMS = [pymodbus, pymodbustcp, umodbus, modbus_tk, easymodbus, pylibmodbus, mbpoll, modbus_cli]


def use(program, place, wanted, told):
    """What one program saw: how often it read, or what was wrong."""
    try:
        read, write = program(*place)
        code = write()
        if code not in (6, TELLS_NOTHING):
            return told.put((program.__name__, f"the write was answered with {code}"))
        reads, until = 0, time.monotonic() + FOR_S
        while time.monotonic() < until or reads < 3:
            values = list(read())
            if values != wanted:
                return told.put((program.__name__, f"read {values} for {wanted}"))
            reads += 1
        told.put((program.__name__, reads))
    except Exception as error:
        told.put((program.__name__, repr(error)))


def together(programs, place, wanted):
    told = Queue()
    uses = [Process(target=use, args=(program, place, wanted, told)) for program in programs]
    for process in uses:
        process.start()
    answers = dict(told.get(timeout=60) for _ in uses)
    for process in uses:
        process.kill()  # Some keep threads that never end.
        process.join()
    return answers


def main(handscope):
    command = [handscope, "share", "--hand", "sim:", "--tcp", "127.0.0.1:0"]
    share = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        host, port = share.stdout.readline().removeprefix("ready tcp ").strip().rsplit(":", 1)
        place = (host, int(port))
        direct = subprocess.run([handscope, "read", "ANGLE_ACT", "--hand", f"tcp:{host}:{port}", "--json"], capture_output=True, text=True)
        wanted = json.loads(direct.stdout)["ANGLE_ACT"]
        there = []
        for program in PROGRAMS:
            (name, reads), = together([program], place, wanted).items()
            if isinstance(reads, str) and re.search("ModuleNotFound|FileNotFound|ImportError|OSError", reads):
                print(f"skipped: {name}: not here ({reads})")
            else:
                assert not isinstance(reads, str), f"{name} alone: {reads}"
                there.append(program)
        assert len(there) >= 2, "no two programs are here"
        for pair in itertools.combinations(there, 2):
            answers = together(pair, place, wanted)
            wrong = {name: what for name, what in answers.items() if isinstance(what, str)}
            assert not wrong, wrong
            print("  ".join(f"{name}: {reads} reads" for name, reads in answers.items()))
        print(f"{len(there)} programs, two at a time: all read the hand, none moved it")
    finally:
        share.terminate()
        share.wait()


if __name__ == "__main__":
    main(*sys.argv[1:])
