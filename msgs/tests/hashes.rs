//! The type hashes against those that ROS 2's own packages state.

use trench_msgs::{services, type_named};

/// Name and hash of each line `"name": "hash"`.
fn entries(json: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    json.lines().filter_map(|line| match line.split('"').collect::<Vec<_>>()[..] {
        [_, name, _, hash, _] => Some((name, hash)),
        _ => None,
    })
}

#[test]
fn hashes_of_messages_are_those_of_ros_2() {
    let mut count = 0;
    for (name, expected) in entries(include_str!("type_hashes.json")) {
        let info = type_named(name).unwrap_or_else(|| panic!("{name} is not generated"));
        assert_eq!(info.hash, expected, "{name}");
        count += 1;
    }
    assert_eq!(count, 44);
    // As `ros2 topic info --verbose` reports it.
    let transforms = type_named("tf2_msgs/msg/TFMessage").map(|info| info.hash);
    assert_eq!(transforms, Some("RIHS01_e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087"));
}

#[test]
fn hashes_of_services_are_those_of_ros_2() {
    // Of the packages' own JSON; those of std_srvs as `ros2 service info --verbose` reports them.
    let expected = [
        (
            "rcl_interfaces/srv/DescribeParameters",
            "RIHS01_845b484d71eb0673dae682f2e3ba3c4851a65a3dcfb97bddd82c5b57e91e4cff",
        ),
        (
            "rcl_interfaces/srv/GetParameterTypes",
            "RIHS01_da199c878688b3e530bdfe3ca8f74cb9fa0c303101e980a9e8f260e25e1c80ca",
        ),
        ("rcl_interfaces/srv/GetParameters", "RIHS01_bf9803d5c74cf989a5de3e0c2e99444599a627c7ff75f97b8c05b01003675cbc"),
        (
            "rcl_interfaces/srv/ListParameters",
            "RIHS01_3e6062bfbb27bfb8730d4cef2558221f51a11646d78e7bb30a1e83afac3aad9d",
        ),
        ("rcl_interfaces/srv/SetParameters", "RIHS01_56eed9a67e169f9cb6c1f987bc88f868c14a8fc9f743a263bc734c154015d7e0"),
        (
            "rcl_interfaces/srv/SetParametersAtomically",
            "RIHS01_0e192ef259c07fc3c07a13191d27002222e65e00ccec653ca05e856f79285fcd",
        ),
        ("std_srvs/srv/Empty", "RIHS01_5888399dedec5ccc85ea6451949fd2c9f97bfdf963f9a588821639fcd31b5d19"),
        ("std_srvs/srv/SetBool", "RIHS01_abe9e4bb6b41b40e6789712c00ec8871923e089af3f667a79992a428cff2da0a"),
        ("std_srvs/srv/Trigger", "RIHS01_eeff2cd6fa5ad9d27cdf4dec64818317839b62f212a91e6b5304b634b2062c5f"),
    ];
    for (name, hash) in expected {
        let service = services().iter().find(|service| service.name == name);
        assert_eq!(service.map(|service| service.hash), Some(hash), "{name}");
    }
}
