//! Keystores as SROS 2 lays them out, made with OpenSSL.

use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// A folder with an authority and enclaves.
pub(crate) struct Keystore(TempDir);

impl Keystore {
    /// With these enclaves, each of which may write and read everything.
    pub(crate) fn new(enclaves: &[&str]) -> Self {
        let keystore = Self(TempDir::new().unwrap());
        fs::create_dir_all(keystore.path().join("authority")).unwrap();
        keystore.openssl("authority", "genpkey -algorithm EC -pkeyopt ec_paramgen_curve:prime256v1 -out key.pem");
        keystore.openssl("authority", "req -x509 -new -key key.pem -sha256 -days 30 -subj /CN=authority -out cert.pem");
        for enclave in enclaves {
            keystore.enclave(enclave);
        }
        keystore
    }

    /// An enclave may not write a topic, by its name in DDS.
    pub(crate) fn denying(self, enclave: &str, topic: &str) -> Self {
        let deny = format!(
            "<deny_rule><domains><id_range><min>0</min></id_range></domains><publish><topics><topic>{topic}</topic></topics></publish></deny_rule>"
        );
        self.sign(enclave, "permissions", &permissions(common_name(enclave), &deny));
        self
    }

    /// As SROS 2 writes it: payloads are encrypted by themselves, too.
    pub(crate) fn with_encrypted_payloads(self, enclaves: &[&str]) -> Self {
        for enclave in enclaves {
            self.sign(enclave, "governance", &governance("ENCRYPT"));
        }
        self
    }

    pub(crate) fn path(&self) -> &Path {
        self.0.path()
    }

    fn enclave(&self, name: &str) {
        let folder = format!("enclaves{name}");
        let inside = self.path().join(&folder);
        fs::create_dir_all(&inside).unwrap();
        let authority = self.path().join("authority");
        self.openssl(&folder, "genpkey -algorithm EC -pkeyopt ec_paramgen_curve:prime256v1 -out key.pem");
        self.openssl(
            &folder,
            &format!("req -new -key key.pem -sha256 -subj /CN={} -out request.pem", common_name(name)),
        );
        let authority = authority.display();
        self.openssl(
            &folder,
            &format!("x509 -req -in request.pem -CA {authority}/cert.pem -CAkey {authority}/key.pem -CAcreateserial -sha256 -days 30 -out cert.pem"),
        );
        for name in ["identity_ca.cert.pem", "permissions_ca.cert.pem"] {
            fs::copy(self.path().join("authority/cert.pem"), inside.join(name)).unwrap();
        }
        self.sign(name, "governance", &governance("NONE"));
        self.sign(name, "permissions", &permissions(common_name(name), ""));
    }

    /// Signs a document as `<document>.p7s` of an enclave.
    fn sign(&self, enclave: &str, document: &str, text: &str) {
        let folder = format!("enclaves{enclave}");
        fs::write(self.path().join(&folder).join(format!("{document}.xml")), text).unwrap();
        let authority = self.path().join("authority");
        let authority = authority.display();
        self.openssl(
            &folder,
            &format!("smime -sign -text -in {document}.xml -out {document}.p7s -signer {authority}/cert.pem -inkey {authority}/key.pem"),
        );
    }

    fn openssl(&self, folder: &str, arguments: &str) {
        let mut command = Command::new("openssl");
        let done = command.args(arguments.split(' ')).current_dir(self.path().join(folder)).output().unwrap();
        assert!(done.status.success(), "openssl {arguments}: {}", String::from_utf8_lossy(&done.stderr));
    }
}

fn common_name(enclave: &str) -> &str {
    enclave.trim_start_matches('/')
}

/// Nobody without a certificate, all submessages encrypted, with what they carry; payloads besides by themselves or not.
fn governance(payloads: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains><id_range><min>0</min></id_range></domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>ENCRYPT</discovery_protection_kind>
      <liveliness_protection_kind>ENCRYPT</liveliness_protection_kind>
      <rtps_protection_kind>SIGN</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>true</enable_discovery_protection>
          <enable_liveliness_protection>true</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>ENCRYPT</metadata_protection_kind>
          <data_protection_kind>{payloads}</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
"#
    )
}

/// All topics, but for what `first` forbids.
fn permissions(name: &str, first: &str) -> String {
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-SECURITY/20170901/omg_shared_ca_permissions.xsd">
  <permissions>
    <grant name="{name}">
      <subject_name>CN={name}</subject_name>
      <validity><not_before>2020-01-01T00:00:00</not_before><not_after>2099-01-01T00:00:00</not_after></validity>
      {first}
      <allow_rule>
        <domains><id_range><min>0</min></id_range></domains>
        <publish><topics><topic>*</topic></topics></publish>
        <subscribe><topics><topic>*</topic></topics></subscribe>
      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
"#
    )
}
